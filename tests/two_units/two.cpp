#include "numbers.hpp"

Numbers numbers_of_two();

Numbers numbers_of_two() { return numbers(); }
