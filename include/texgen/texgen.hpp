#pragma once

// The umbrella: everything but reference.hpp and eigen.hpp, which need Eigen, and scene.hpp, which needs std::vector: what
// the umbrella costs every file to compile is kept below three times GLM's own headers.

#include "clip.hpp"
#include "conventions.hpp"
#include "diagnose.hpp"
#include "fixed_function.hpp"
#include "footprint.hpp"
#include "interpolate.hpp"
#include "linear.hpp"
#include "primitives.hpp"
#include "projector.hpp"
#include "scale_bias.hpp"
#include "skip.hpp"
#include "texcoord.hpp"
#include "transform.hpp"
