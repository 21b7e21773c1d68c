#pragma once

// Floor 9: the umbrella, everything but reference.hpp and eigen.hpp, which need Eigen, and batch.hpp, scene.hpp and
// diagnose.hpp, which few files need: what the umbrella costs every file to compile stays below 4 times GLM's own
// headers.

#include "detail/language.hpp"

#include "clip.hpp"
#include "conventions.hpp"
#include "coverage.hpp"
#include "fixed_function.hpp"
#include "footprint.hpp"
#include "interpolate.hpp"
#include "linear.hpp"
#include "primitives.hpp"
#include "projector.hpp"
#include "scale_bias.hpp"
#include "segment.hpp"
#include "surface.hpp"
#include "texcoord.hpp"
#include "transform.hpp"
