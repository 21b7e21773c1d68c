// the triangles of a batch that face the projector, with no word on where t grows to
#include <span>

#include <texgen/batch.hpp>

using namespace texgen;

void assign(TriangleBatch& batch, std::span<const Triangle> triangles) {
#ifndef MISUSE
    batch.assign_facing(triangles, TextureOrigin::bottom_left);
#else
    batch.assign_facing(triangles);
#endif
}
