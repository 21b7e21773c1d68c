#include <cstdio>

#include "numbers.hpp"

Numbers numbers_of_two();

namespace {

int failures = 0;

void expect(bool holds, const char* what) {
    if (holds) return;
    std::printf("not so: %s\n", what);
    ++failures;
}

bool has_both(const Plane& lit) {
    bool dark = false, bright = false;
    for (float value : lit) (value == 1.0f ? bright : dark) = true;
    return dark && bright;
}

}  // namespace

int main() {
#ifdef NEEDS_AVX2
    if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return 77;
#endif
    const Numbers one = numbers();
    const Numbers two = numbers_of_two();
#ifdef NEEDS_AVX2
    expect(one.interpolate != two.interpolate, "each unit has the functions of its own flags");
#endif
    expect(has_both(one.point_lit), "some points are lit and some are not");
    expect(has_both(one.fragment_lit), "some fragments are lit and some are not");
    // Both are the nearest floats.
    expect(one.point_s == two.point_s && one.point_t == two.point_t, "the units agree on points");
    expect(one.fragment_s == two.fragment_s && one.fragment_t == two.fragment_t, "the units agree on fragments");
    return failures;
}
