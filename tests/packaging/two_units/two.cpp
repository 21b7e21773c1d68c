#include "numbers.hpp"

#ifndef EXPORTED
#define EXPORTED
#endif

EXPORTED Numbers numbers_of_two();

Numbers numbers_of_two() { return numbers(); }
