// The inverse of a matrix that is next to singular is what sums find that are compensated: a compiler that reorders
// sums takes what compensates them for 0. The matrices are products of integers with determinant 1, so that the
// inverses are known.

#include <cmath>
#include <cstdint>
#include <cstdio>

#include <glm/mat4x4.hpp>
#include <texgen/transform.hpp>

int main() {
    std::uint64_t state = 1;
    // In [-32, 31]. The constants are Knuth's (MMIX).
    const auto integer = [&] {
        state = state * 6364136223846793005u + 1442695040888963407u;
        return static_cast<double>(static_cast<int>(state >> 58) - 32);
    };
    double worst = 0;
    for (int round = 0; round < 1000; ++round) {
        glm::dmat4 matrix(1), expected(1);
        for (int row = 0; row < 4; ++row) {
            glm::dmat4 shear(1), back(1);
            for (int column = 0; column < 4; ++column) {
                if (column == row) continue;
                shear[column][row] = integer();
                back[column][row] = -shear[column][row];
            }
            matrix = matrix * shear;
            expected = back * expected;
        }
        const auto computed = texgen::inverse(texgen::ModelMatrix(matrix));
        if (!computed) {
            std::puts("refused");
            return 1;
        }
        for (int k = 0; k < 16; ++k) {
            const double exact = expected[k / 4][k % 4];
            worst =
                std::fmax(worst, std::fabs(computed->matrix()[k / 4][k % 4] - exact) / std::fmax(1, std::fabs(exact)));
        }
    }
    std::printf("off by %g of an element at most\n", worst);
    return worst <= 0x1p-50 ? 0 : 1;
}
