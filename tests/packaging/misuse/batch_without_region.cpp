// a batch of triangles without what its coordinates are inside of
#include <texgen/batch.hpp>

using namespace texgen;

TriangleBatch batch() {
#ifndef MISUSE
    return TriangleBatch(whole_texture(), texels(0.5, 4096.0));
#else
    return TriangleBatch(texels(0.5, 4096.0));
#endif
}
