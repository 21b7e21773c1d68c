// The kernels of all tests: the one file of the macro's kind.
#define TEXGEN_DEFINE_KERNELS
#include <texgen/texgen.hpp>
