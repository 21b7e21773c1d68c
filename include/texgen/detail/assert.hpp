#pragma once

// The macro that checks preconditions. A project may define a TEXGEN_ASSERT of its own before the first include.
#ifndef TEXGEN_ASSERT
#include <cassert>
#define TEXGEN_ASSERT(condition) assert(condition)
#endif
