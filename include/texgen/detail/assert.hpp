#pragma once

// The one macro for broken preconditions. A project that has its own defines TEXGEN_ASSERT before the first include.
#ifndef TEXGEN_ASSERT
#include <cassert>
#define TEXGEN_ASSERT(condition) assert(condition)
#endif
