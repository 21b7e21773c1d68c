// a pinhole that does not say where the centres of its pixels are
#include <texgen/projector.hpp>

using namespace texgen;

PinholeLens lens() {
#ifndef MISUSE
    return {.fx = 500,
            .fy = 500,
            .cx = 319.5,
            .cy = 239.5,
            .width = 640,
            .height = 480,
            .z_near = 0.1,
            .z_far = 10,
            .centre = PixelCentre::integer};
#else
    return {.fx = 500, .fy = 500, .cx = 319.5, .cy = 239.5, .width = 640, .height = 480, .z_near = 0.1, .z_far = 10};
#endif
}
