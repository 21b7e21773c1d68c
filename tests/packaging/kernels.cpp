// The kernels of all files of a program: the one file of the macro's kind.
#define TEXGEN_DEFINE_KERNELS
#include <texgen/batch.hpp>
#include <texgen/texgen.hpp>
