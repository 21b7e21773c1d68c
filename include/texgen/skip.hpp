#pragma once

// Floor 7: the former name of coverage.hpp, until 0.5.

#include "detail/language.hpp"

#include "coverage.hpp"
