// GLM is configured after it was included, so that its types are not what the macro says.
#define GLM_FORCE_INTRINSICS
#include <glm/vec3.hpp>

#define GLM_FORCE_DEFAULT_ALIGNED_GENTYPES
#include <texgen/conventions.hpp>
