#pragma once

#include <cstdio>

// Whether all of standard output has arrived where it goes: that a disk is full is not known before it is flushed.
inline bool is_printed() { return std::fflush(stdout) == 0 && std::ferror(stdout) == 0; }
