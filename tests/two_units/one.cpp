#include <cmath>
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

// Both are within 0.51 ulp of the exact value, so they are neighbours at most.
bool agree(const Plane& a, const Plane& b) {
    for (std::size_t i = 0; i < a.size(); ++i)
        if (a[i] != b[i] && std::nextafter(a[i], b[i]) != b[i]) return false;
    return true;
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
    expect(agree(one.point_s, two.point_s) && agree(one.point_t, two.point_t), "the units agree on points");
    expect(agree(one.fragment_s, two.fragment_s) && agree(one.fragment_t, two.fragment_t),
           "the units agree on fragments");
    return failures;
}
