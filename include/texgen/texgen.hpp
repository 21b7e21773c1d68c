#pragma once

// The umbrella: everything but reference.hpp and eigen.hpp, which need Eigen.

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
#include "scene.hpp"
#include "skip.hpp"
#include "texcoord.hpp"
#include "transform.hpp"
