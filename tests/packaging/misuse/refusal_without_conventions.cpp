// why a lens and an aim make no projector, with no word on the conventions that they are made for
#include <texgen/diagnose.hpp>

using namespace texgen;

Diagnosis why(const PerspectiveLens& lens, const Aim& aim) {
#ifndef MISUSE
    return diagnose(lens, aim, opengl);
#else
    return diagnose(lens, aim);
#endif
}
