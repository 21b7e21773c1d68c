#pragma once

// Floor 7: the former name of coverage.hpp, for a release.

#include "detail/language.hpp"

#include "coverage.hpp"
