#pragma once

// The inverse of a 4x4 with a certificate. A determinant says nothing about singularity (it has a scale), the residual
// does: if norm(I - A X) < 1 for any X at all, A is regular, and A^-1 is as near to X as the residual is small.

#include <cmath>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include "rounding.hpp"

namespace TEXGEN_DETAIL {

inline bool is_finite(const glm::dmat4& m) noexcept {
    return is_finite(m[0]) && is_finite(m[1]) && is_finite(m[2]) && is_finite(m[3]);
}

inline glm::dvec4 times_powers_of_two(const glm::dvec4& v, const glm::ivec4& exponent) noexcept {
    return {times_power_of_two(v.x, exponent.x), times_power_of_two(v.y, exponent.y),
            times_power_of_two(v.z, exponent.z), times_power_of_two(v.w, exponent.w)};
}

// The magnitudes of the elements. glm::abs() is not used, as it calls a function for each.
inline glm::dvec4 absolute(const glm::dvec4& v) noexcept {
    return {std::fabs(v.x), std::fabs(v.y), std::fabs(v.z), std::fabs(v.w)};
}
inline glm::dmat4 absolute(const glm::dmat4& m) noexcept {
    return {absolute(m[0]), absolute(m[1]), absolute(m[2]), absolute(m[3])};
}

// The least magnitude, but 0, to which scaling may bring an element. Below it the element could be rounded, and B would
// be another matrix: one of rank 3 could look regular.
inline constexpr double least_scaled = 0x1p-900;

class CertifiedInverse {
public:
    // The matrix is first scaled by powers of two, B = R A C, so that rows and columns are near 1: this is exact and
    // makes every later decision independent of uniform and of diagonal scale. X ~ B^-1 comes from one elimination and
    // two steps of refinement with a doubled residual, or more, until each element is as good as its terms.
    explicit CertifiedInverse(const glm::dmat4& matrix) noexcept : scaled_(matrix) {
        if (!is_finite(matrix) || !equilibrate() || !eliminate()) return;
        clear_what_has_no_terms();
        glm::dmat4 lacking = residual();
        beta_ = certificate(lacking);
        if (!is_regular()) return;
        // A step, X <- X + X (I - B X), takes about 50 bits from the error, and elements lie within 900 bits.
        constexpr int most_steps = 20;
        inverse_ += inverse_ * lacking;
        for (int step = 2; step <= most_steps; ++step) {
            const glm::dmat4 before = inverse_;
            lacking = residual();
            const bool is_last = is_as_good_as_its_terms(lacking);
            inverse_ += before * lacking;
            if (is_last || inverse_ == before) return;
        }
    }

    // Whether norm(I - B X) + 5 u norm(|X| |B|) for the X of the elimination is below 1, which proves that A is
    // regular. For an exactly singular A it is at least 1 for every X: with y B = 0, y (I - B X) = y. False where A is
    // not finite.
    bool is_regular() const noexcept { return beta_ < 1.0; }

    // A^-1 = C X R; each element within 2 ulp of the largest of its terms in A^-1 A A^-1 while the condition of B stays
    // below 1e8 and its terms, in X B X, above least_scaled. That may be as little as half an ulp of the element: (B
    // X)_jj = 1 has four terms, so one of X B X is at least a quarter of the element.
    glm::dmat4 matrix() const noexcept {
        glm::dmat4 result;
        for (glm::length_t j = 0; j < 4; ++j)
            result[j] = times_powers_of_two(inverse_[j], column_exponent_ + row_exponent_[j]);
        return result;
    }

    // row A^-1, solved and refined by itself: the product of row and a rounded inverse could cancel.
    glm::dvec4 solve_row(const glm::dvec4& row) const noexcept {
        // y A = row with B = R A C is (y R^-1) B = row C.
        const glm::dvec4 target = times_powers_of_two(row, column_exponent_);
        glm::dvec4 solution(0.0), residual = target;
        for (int pass = 0; pass < 3; ++pass) {
            for (glm::length_t j = 0; j < 4; ++j)
                for (glm::length_t k = 0; k < 4; ++k) solution[j] += residual[k] * inverse_[j][k];
            for (glm::length_t j = 0; j < 4; ++j) residual[j] = residual_of(solution, scaled_[j], target[j]);
        }
        return times_powers_of_two(solution, row_exponent_);
    }

    // A bound on |solution - rows A^-1|, element by element, for any solution: solve_row()'s, or matrix() for the rows
    // of the identity, or one from elsewhere. A NaN or an infinity of the solution stays one in the bound; infinite
    // where A is not regular.
    glm::dmat4 error_of(const glm::dmat4& solution, const glm::dmat4& rows) const noexcept {
        const double r = contraction();
        const glm::dmat4 solved = glm::transpose(solution), given = glm::transpose(rows);
        return glm::transpose(glm::dmat4(error_of_row(solved[0], given[0], r), error_of_row(solved[1], given[1], r),
                                         error_of_row(solved[2], given[2], r), error_of_row(solved[3], given[3], r)));
    }
    glm::dvec4 error_of(const glm::dvec4& solution, const glm::dvec4& row) const noexcept {
        return error_of_row(solution, row, contraction());
    }

private:
    // start - row . column, computed in two doubles.
    static double residual_of(const glm::dvec4& row, const glm::dvec4& column, double start) noexcept {
        const DoubleDouble half = add_product(add_product({start, 0.0}, -row.x, column.x), -row.y, column.y);
        return add_product(add_product(half, -row.z, column.z), -row.w, column.w).high;
    }

    // False where a row or a column is 0, or an element becomes smaller than least_scaled.
    bool equilibrate() noexcept {
        bool is_exact = true;
        // Rows, then columns, three times.
        for (int pass = 0; pass < 6; ++pass) {
            scaled_ = glm::transpose(scaled_);
            for (glm::length_t i = 0; i < 4; ++i) {
                const glm::dvec4 line = scaled_[i];
                const double largest =
                    larger(larger(std::fabs(line.x), std::fabs(line.y)), larger(std::fabs(line.z), std::fabs(line.w)));
                if (largest == 0.0) return false;
                const int shift = -exponent_of(largest);
                if (shift != 0) scaled_[i] = times_powers_of_two(line, glm::ivec4(shift));
                for (glm::length_t k = 0; k < 4; ++k)
                    is_exact = is_exact && (line[k] == 0.0 || std::fabs(scaled_[i][k]) >= least_scaled);
                (pass % 2 == 0 ? row_exponent_ : column_exponent_)[i] += shift;
            }
        }
        return is_exact;
    }

    // Gauss-Jordan with partial pivoting.
    bool eliminate() noexcept {
        glm::dmat4 left = glm::transpose(scaled_), right(1.0);  // rows
        for (glm::length_t column = 0; column < 4; ++column) {
            glm::length_t pivot = column;
            for (glm::length_t row = column + 1; row < 4; ++row)
                if (std::fabs(left[row][column]) > std::fabs(left[pivot][column])) pivot = row;
            if (left[pivot][column] == 0.0) return false;
            std::swap(left[pivot], left[column]);
            std::swap(right[pivot], right[column]);
            const double reciprocal = 1.0 / left[column][column];
            left[column] *= reciprocal;
            right[column] *= reciprocal;
            for (glm::length_t row = 0; row < 4; ++row) {
                if (row == column) continue;
                const double factor = left[row][column];
                left[row] -= factor * left[column];
                right[row] -= factor * right[column];
            }
        }
        inverse_ = glm::transpose(right);
        return true;
    }

    // Sets to 0 what is exactly 0 in B^-1. An element of B^-1 is a cofactor over the determinant, and 0 where each
    // product in the cofactor has a factor 0. What elimination leaves there is never small beside terms that are 0. A
    // cofactor has a product without a 0 where each one, two and three of its rows have nonzero elements in as many
    // columns (Hall's marriage theorem).
    void clear_what_has_no_terms() noexcept {
        unsigned rows[4] = {};  // a bit for each column where it is not 0
        for (glm::length_t i = 0; i < 4; ++i)
            for (glm::length_t j = 0; j < 4; ++j) rows[j] |= scaled_[i][j] != 0.0 ? 1u << i : 0u;
        const auto without_last = [](unsigned bits) { return bits & (bits - 1); };
        for (glm::length_t i = 0; i < 4; ++i) {
            for (glm::length_t j = 0; j < 4; ++j) {
                const auto row = [&](glm::length_t k) { return rows[(j + k) % 4] & ~(1u << i); };
                const unsigned a = row(1), b = row(2), c = row(3);
                const bool has_term = a != 0 && b != 0 && c != 0 && without_last(a | b) != 0 &&
                                      without_last(b | c) != 0 && without_last(c | a) != 0 &&
                                      without_last(without_last(a | b | c)) != 0;
                if (!has_term) inverse_[j][i] = 0.0;
            }
        }
    }

    // I - B X.
    glm::dmat4 residual() const noexcept {
        const glm::dmat4 rows = glm::transpose(scaled_);
        glm::dmat4 result;
        for (glm::length_t i = 0; i < 4; ++i)
            for (glm::length_t j = 0; j < 4; ++j) result[j][i] = residual_of(rows[i], inverse_[j], i == j ? 1.0 : 0.0);
        return result;
    }

    double certificate(const glm::dmat4& residual) const noexcept {
        const glm::dvec4 all(1.0);
        const glm::dvec4 of_residual = absolute(residual) * all;
        const glm::dvec4 of_product = absolute(inverse_) * absolute(scaled_) * all;
        double residual_norm = 0.0, product_norm = 0.0;
        for (glm::length_t i = 0; i < 4; ++i) {
            residual_norm = larger_or_nan(residual_norm, of_residual[i]);
            product_norm = larger_or_nan(product_norm, of_product[i]);
        }
        return residual_norm + 5.0 * unit_roundoff_double * product_norm;
    }

    // Whether each element is within 2 ulp of the largest of its terms in X B X. With R = I - B X, X lacks X R + X R^2
    // + ... Where no element of R is above 2^-10, the sum of all powers of |R| is at most 1.1 (|R| + |R|^2 + |R|^3),
    // element by element: a path of more than 3 steps between 4 indices contains a circle. R itself errs by 2^-100 of
    // the terms of I and B X, which changes X by about 2^-100 of its terms.
    bool is_as_good_as_its_terms(const glm::dmat4& residual) const noexcept {
        const glm::dmat4 r = absolute(residual);
        const glm::dmat4 powers = r + r * (r + r * r);
        const glm::dmat4 lacking = absolute(inverse_ * residual) + gamma(5) * (absolute(inverse_) * r);
        const glm::dmat4 error = lacking + 1.1 * (lacking * powers);
        const glm::dmat4 b = absolute(glm::transpose(scaled_)), x = absolute(glm::transpose(inverse_));  // rows
        for (glm::length_t i = 0; i < 4; ++i) {
            glm::dvec4 of_product(0.0), largest(0.0);
            for (glm::length_t k = 0; k < 4; ++k) of_product = (glm::max)(of_product, x[i][k] * b[k]);
            for (glm::length_t k = 0; k < 4; ++k) largest = (glm::max)(largest, of_product[k] * x[k]);
            for (glm::length_t j = 0; j < 4; ++j) {
                if (!(r[j][i] <= 0x1p-10)) return false;
                // Nothing is promised where terms may leave the range.
                if (largest[j] < least_scaled) continue;
                if (!(error[j][i] < times_power_of_two(1.999, exponent_of(largest[j]) - 52))) return false;
            }
        }
        return true;
    }

    // A bound on the largest sum of a column of |I - B X|. Infinite where A is not regular.
    double contraction() const noexcept {
        if (!is_regular()) return infinity;
        const glm::dmat4 terms = glm::dmat4(1.0) + absolute(scaled_) * absolute(inverse_);
        const glm::dmat4 r = absolute(residual()) * (1.0 + gamma(2)) + terms * 0x1p-99 + 0x1p-1000;
        double largest = 0.0;
        for (const glm::dvec4& column : {r[0], r[1], r[2], r[3]})
            largest = larger_or_nan(largest, 1.001 * (column.x + column.y + column.z + column.w));
        return largest;
    }

    // As in solve_row(), y B = target. With rho = target - y B and R = I - B X, what y lacks is rho B^-1 = d (I - R)^-1
    // with d = rho X. Each |d R|_j is at most max|d| r, r the largest sum of a column of |R|: so |y_j - exact| <= |d_j|
    // + max|d| r / (1 - r).
    glm::dvec4 error_of_row(const glm::dvec4& solution, const glm::dvec4& row, double contraction) const noexcept {
        if (!(contraction < 1.0)) return glm::dvec4(infinity);
        const glm::dvec4 scaled_solution = times_powers_of_two(solution, -row_exponent_);
        const glm::dvec4 target = times_powers_of_two(row, column_exponent_);
        const glm::dmat4 x = glm::transpose(inverse_);  // rows
        glm::dvec4 d(0.0), error(0.0);
        for (glm::length_t k = 0; k < 4; ++k) {
            const double rho = residual_of(scaled_solution, scaled_[k], target[k]);
            // rho has one rounding, four sums within 2^-102 of the terms, and products that may underflow.
            const double terms = std::fabs(target[k]) + glm::dot(absolute(scaled_solution), absolute(scaled_[k]));
            const double rho_error = gamma(2) * std::fabs(rho) + 0x1p-99 * terms + 0x1p-1000;
            d += rho * x[k];
            error += (rho_error + gamma(5) * std::fabs(rho)) * absolute(x[k]);
        }
        const glm::dvec4 bound = absolute(d) + error;
        double largest = 0.0;
        for (glm::length_t j = 0; j < 4; ++j) largest = larger_or_nan(largest, bound[j]);
        const double remainder = largest * (contraction / (1.0 - contraction));
        return times_powers_of_two(1.001 * (bound + remainder) + 0x1p-1000, row_exponent_) + 0x1p-1074;
    }

    glm::dmat4 scaled_;              // B
    glm::dmat4 inverse_{0.0};        // X
    glm::ivec4 row_exponent_{0};     // R = diag(2^row_exponent)
    glm::ivec4 column_exponent_{0};  // C = diag(2^column_exponent)
    double beta_ = infinity;
};

// How far the 3x3 part is from orthonormal, and the last row from (0, 0, 0, 1): the largest deviation.
inline double distance_from_rigid(const glm::dmat4& m) noexcept {
    double distance = 0.0;
    const auto include = [&distance](double deviation) { distance = larger_or_nan(distance, std::fabs(deviation)); };
    for (glm::length_t i = 0; i < 3; ++i) {
        for (glm::length_t j = 0; j <= i; ++j)
            include(m[i][0] * m[j][0] + m[i][1] * m[j][1] + m[i][2] * m[j][2] - (i == j ? 1.0 : 0.0));
        include(m[i][3]);
    }
    include(m[3][3] - 1.0);
    return distance;
}

}  // namespace TEXGEN_DETAIL
