#pragma once

// The inverse of a 4x4 with a certificate. A determinant says nothing about singularity (it has a scale), the residual
// does: if norm(I - A X) < 1 for any X at all, A is regular, and A^-1 is as near to X as the residual is small.

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <glm/common.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include "rounding.hpp"

namespace TEXGEN_DETAIL {

inline bool is_finite(double value) noexcept { return std::fabs(value) <= 1.7976931348623157e308; }

inline bool is_finite(const glm::dmat4& matrix) noexcept {
    for (glm::length_t column = 0; column < 4; ++column)
        for (glm::length_t row = 0; row < 4; ++row)
            if (!is_finite(matrix[column][row])) return false;
    return true;
}

// The magnitudes of the elements.
inline glm::dmat4 absolute(const glm::dmat4& m) noexcept {
    return {glm::abs(m[0]), glm::abs(m[1]), glm::abs(m[2]), glm::abs(m[3])};
}

// An element other than 0 that scaling makes smaller could be rounded there, and B would be another matrix: one of rank 3
// could look regular.
inline constexpr double least_scaled = 0x1p-900;

class CertifiedInverse {
public:
    // The matrix is first scaled by powers of two, B = R A C, so that rows and columns are near 1: this is exact and
    // makes every later decision independent of uniform and of diagonal scale. X ~ B^-1 is one elimination and steps of
    // refinement with a doubled residual: two, and more where elements are far apart, until each is as good as its terms.
    explicit CertifiedInverse(const glm::dmat4& matrix) noexcept;

    // Whether norm(I - B X) + 5 u norm(|X| |B|) for the X of the elimination is below 1, which proves that A is regular. For
    // an exactly singular A it is at least 1 for every X: with y B = 0, y (I - B X) = y. False for what is not finite.
    bool regular() const noexcept { return beta_ < 1.0; }

    // A^-1 = C X R; each element within 2 ulp of the largest of its terms in A^-1 A A^-1 while the condition of B stays
    // below 1e8 and its terms, in X B X, above least_scaled.
    glm::dmat4 matrix() const noexcept;

    // row A^-1, solved and refined by itself: the product of row and a rounded inverse could cancel.
    glm::dvec4 solve_row(const glm::dvec4& row) const noexcept;

    // A bound on |solution - rows A^-1|, element by element, for any solution: solve_row()'s, or matrix() for the rows of
    // the identity, or one from elsewhere. A NaN or an infinity stays one; infinite where A is not regular.
    glm::dmat4 error_of(const glm::dmat4& solution, const glm::dmat4& rows) const noexcept;
    glm::dvec4 error_of(const glm::dvec4& solution, const glm::dvec4& row) const noexcept {
        return error_of_row(solution, row, contraction());
    }

private:
    using Row = std::array<double, 4>;
    using Square = std::array<Row, 4>;  // [row][column]

    // start - row . column of a matrix.
    static double residual_of(const Row& row, const Square& matrix, std::size_t column, double start) noexcept {
        DoubleDouble sum{start, 0.0};
        for (std::size_t k = 0; k < 4; ++k) sum = add_product(sum, -row[k], matrix[k][column]);
        return sum.high;
    }

    // The same and a bound on its error: one rounding, four sums within 2^-102 of the terms, and products that underflow.
    static Bounded bounded_residual_of(const Row& row, const Square& matrix, std::size_t column,
                                       double start) noexcept {
        const double value = residual_of(row, matrix, column, start);
        double magnitude = std::fabs(start);
        for (std::size_t k = 0; k < 4; ++k) magnitude += std::fabs(row[k]) * std::fabs(matrix[k][column]);
        return {value, gamma(2) * std::fabs(value) + 0x1p-99 * magnitude + 0x1p-1000};
    }

    bool equilibrate() noexcept;
    bool eliminate() noexcept;
    void clear_what_has_no_terms() noexcept;
    Square residual() const noexcept;
    double certificate(const Square& residual) const noexcept;
    bool correct(const Square& residual) noexcept;
    bool is_as_good_as_its_terms(const Square& residual) const noexcept;
    double contraction() const noexcept;
    glm::dvec4 error_of_row(const glm::dvec4& solution, const glm::dvec4& row, double contraction) const noexcept;

    Square scaled_{};                       // B
    Square inverse_{};                      // X
    std::array<int, 4> row_exponent_{};     // R = diag(2^row_exponent)
    std::array<int, 4> column_exponent_{};  // C = diag(2^column_exponent)
    double beta_ = std::numeric_limits<double>::infinity();
};

inline CertifiedInverse::CertifiedInverse(const glm::dmat4& matrix) noexcept {
    for (glm::length_t row = 0; row < 4; ++row) {
        for (glm::length_t column = 0; column < 4; ++column) {
            const double element = matrix[column][row];
            if (!is_finite(element)) return;
            scaled_[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] = element;
        }
    }
    if (!equilibrate() || !eliminate()) return;
    clear_what_has_no_terms();
    Square residual = this->residual();
    beta_ = certificate(residual);
    if (!regular()) return;
    // A step takes about 50 bits from what is noise: 900 in all lie between the elements.
    constexpr int most_steps = 20;
    correct(residual);
    for (int step = 2; step <= most_steps; ++step) {
        residual = this->residual();
        const bool is_last = is_as_good_as_its_terms(residual);
        if (!correct(residual) || is_last) return;
    }
}

// False where a row or a column is 0, or an element becomes smaller than least_scaled.
inline bool CertifiedInverse::equilibrate() noexcept {
    bool is_exact = true;
    const auto scale = [&is_exact](double& element, int shift) {
        is_exact = is_exact && (element == 0.0 || std::fabs(std::scalbn(element, shift)) >= least_scaled);
        element = std::scalbn(element, shift);
    };
    // Rows, then columns, three times.
    for (int pass = 0; pass < 6; ++pass) {
        const bool is_of_rows = pass % 2 == 0;
        for (std::size_t i = 0; i < 4; ++i) {
            const auto element = [&](std::size_t k) -> double& { return is_of_rows ? scaled_[i][k] : scaled_[k][i]; };
            double largest = 0.0;
            for (std::size_t k = 0; k < 4; ++k) largest = std::fmax(largest, std::fabs(element(k)));
            if (largest == 0.0) return false;
            const int shift = -std::ilogb(largest);
            for (std::size_t k = 0; k < 4; ++k) scale(element(k), shift);
            (is_of_rows ? row_exponent_ : column_exponent_)[i] += shift;
        }
    }
    return is_exact;
}

// Gauss-Jordan with partial pivoting.
inline bool CertifiedInverse::eliminate() noexcept {
    Square left = scaled_;
    Square& right = inverse_;
    for (std::size_t i = 0; i < 4; ++i) right[i][i] = 1.0;
    for (std::size_t column = 0; column < 4; ++column) {
        std::size_t pivot = column;
        for (std::size_t row = column + 1; row < 4; ++row)
            if (std::fabs(left[row][column]) > std::fabs(left[pivot][column])) pivot = row;
        if (left[pivot][column] == 0.0) return false;
        std::swap(left[pivot], left[column]);
        std::swap(right[pivot], right[column]);
        const double reciprocal = 1.0 / left[column][column];
        for (std::size_t k = 0; k < 4; ++k) {
            left[column][k] *= reciprocal;
            right[column][k] *= reciprocal;
        }
        for (std::size_t row = 0; row < 4; ++row) {
            if (row == column) continue;
            const double factor = left[row][column];
            for (std::size_t k = 0; k < 4; ++k) {
                left[row][k] -= factor * left[column][k];
                right[row][k] -= factor * right[column][k];
            }
        }
    }
    return true;
}

// An element of B^-1 is a cofactor over the determinant. Where a factor of each of the cofactor's products is 0 so is the
// element; what elimination has left there would never be small beside terms that are 0.
inline void CertifiedInverse::clear_what_has_no_terms() noexcept {
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
            const auto is_factor = [&](std::size_t row, std::size_t column) {
                return scaled_[(j + row) % 4][(i + column) % 4] != 0.0;
            };
            bool has_term = false;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t l = 1 + (k + 1) % 3, m = 1 + (k + 2) % 3;
                has_term = has_term || (is_factor(1, 1 + k) &&
                                        ((is_factor(2, l) && is_factor(3, m)) || (is_factor(2, m) && is_factor(3, l))));
            }
            if (!has_term) inverse_[i][j] = 0.0;
        }
    }
}

// I - B X.
inline CertifiedInverse::Square CertifiedInverse::residual() const noexcept {
    Square result;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) result[i][j] = residual_of(scaled_[i], inverse_, j, i == j ? 1.0 : 0.0);
    return result;
}

inline double CertifiedInverse::certificate(const Square& residual) const noexcept {
    double residual_norm = 0.0;
    double product_norm = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
        double of_residual = 0.0;
        double product = 0.0;
        for (std::size_t j = 0; j < 4; ++j) {
            of_residual += std::fabs(residual[i][j]);
            for (std::size_t k = 0; k < 4; ++k) product += std::fabs(inverse_[i][k]) * std::fabs(scaled_[k][j]);
        }
        residual_norm = larger_or_nan(residual_norm, of_residual);
        product_norm = larger_or_nan(product_norm, product);
    }
    return residual_norm + 5.0 * unit_roundoff_double * product_norm;
}

// X <- X + X (I - B X). Whether that changes X.
inline bool CertifiedInverse::correct(const Square& residual) noexcept {
    const Square before = inverse_;
    bool is_changed = false;
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
            double correction = 0.0;
            for (std::size_t k = 0; k < 4; ++k) correction += before[i][k] * residual[k][j];
            inverse_[i][j] = before[i][j] + correction;
            is_changed = is_changed || inverse_[i][j] != before[i][j];
        }
    }
    return is_changed;
}

// Whether each element is within 2 ulp of the largest of its terms in X B X. With R = I - B X, X lacks X R + X R^2 + ...
// Where no element of R is above 2^-10, the sum of all powers of |R| is at most 1.1 (|R| + |R|^2 + |R|^3), element by
// element: a path of more than 3 steps between 4 places goes in a circle. The error of R itself, 2^-100 of the terms of
// I and B X, adds as little to X as that.
inline bool CertifiedInverse::is_as_good_as_its_terms(const Square& residual) const noexcept {
    Square lacking{};
    Square powers{};
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
            double sum = 0.0;
            double size = 0.0;
            for (std::size_t k = 0; k < 4; ++k) {
                const double term = inverse_[i][k] * residual[k][j];
                sum += term;
                size += std::fabs(term);
            }
            lacking[i][j] = std::fabs(sum) + gamma(5) * size;
            powers[i][j] = std::fabs(residual[i][j]);
            if (!(powers[i][j] <= 0x1p-10)) return false;
        }
    }
    const Square first = powers;
    for (int power = 2; power <= 3; ++power) {
        const Square before = powers;
        for (std::size_t i = 0; i < 4; ++i) {
            for (std::size_t j = 0; j < 4; ++j) {
                powers[i][j] = first[i][j];
                for (std::size_t k = 0; k < 4; ++k) powers[i][j] += first[i][k] * before[k][j];
            }
        }
    }
    for (std::size_t i = 0; i < 4; ++i) {
        Row largest_in_product{};
        for (std::size_t k = 0; k < 4; ++k)
            for (std::size_t l = 0; l < 4; ++l)
                largest_in_product[l] = larger(largest_in_product[l], std::fabs(inverse_[i][k] * scaled_[k][l]));
        for (std::size_t j = 0; j < 4; ++j) {
            double largest = 0.0;
            double error = lacking[i][j];
            for (std::size_t k = 0; k < 4; ++k) {
                largest = larger(largest, largest_in_product[k] * std::fabs(inverse_[k][j]));
                error += 1.1 * lacking[i][k] * powers[k][j];
            }
            // Nothing is promised of what may leave the range.
            if (largest < least_scaled) continue;
            if (!(error < std::scalbn(1.999, std::ilogb(largest) - 52))) return false;
        }
    }
    return true;
}

inline glm::dmat4 CertifiedInverse::matrix() const noexcept {
    glm::dmat4 result(0.0);
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j)
            result[static_cast<glm::length_t>(j)][static_cast<glm::length_t>(i)] =
                std::scalbn(inverse_[i][j], column_exponent_[i] + row_exponent_[j]);
    return result;
}

inline glm::dvec4 CertifiedInverse::solve_row(const glm::dvec4& row) const noexcept {
    // y A = row with B = R A C is (y R^-1) B = row C.
    Row target{};
    for (std::size_t k = 0; k < 4; ++k)
        target[k] = std::scalbn(row[static_cast<glm::length_t>(k)], column_exponent_[k]);
    Row solution{};
    Row residual = target;
    for (int pass = 0; pass < 3; ++pass) {
        for (std::size_t j = 0; j < 4; ++j)
            for (std::size_t k = 0; k < 4; ++k) solution[j] += residual[k] * inverse_[k][j];
        for (std::size_t j = 0; j < 4; ++j) residual[j] = residual_of(solution, scaled_, j, target[j]);
    }
    glm::dvec4 result(0.0);
    for (std::size_t j = 0; j < 4; ++j)
        result[static_cast<glm::length_t>(j)] = std::scalbn(solution[j], row_exponent_[j]);
    return result;
}

// The largest sum of a column of |I - B X|. Infinite where A is not regular.
inline double CertifiedInverse::contraction() const noexcept {
    if (!regular()) return std::numeric_limits<double>::infinity();
    double largest = 0.0;
    for (std::size_t j = 0; j < 4; ++j) {
        double sum = 0.0;
        for (std::size_t i = 0; i < 4; ++i) {
            const Bounded residual = bounded_residual_of(scaled_[i], inverse_, j, i == j ? 1.0 : 0.0);
            sum += std::fabs(residual.value) + residual.error;
        }
        largest = larger_or_nan(largest, 1.001 * sum);
    }
    return largest;
}

// As in solve_row(), y B = target. With rho = target - y B and R = I - B X, what y lacks is rho B^-1 = d (I - R)^-1 with
// d = rho X. Each |d R|_j is at most max|d| r, r the largest sum of a column of |R|: so |y_j - exact| <= |d_j| +
// max|d| r / (1 - r).
inline glm::dvec4 CertifiedInverse::error_of_row(const glm::dvec4& solution, const glm::dvec4& row,
                                                 double contraction) const noexcept {
    if (!(contraction < 1.0)) return glm::dvec4(std::numeric_limits<double>::infinity());
    Row scaled_solution{};
    for (std::size_t k = 0; k < 4; ++k)
        scaled_solution[k] = std::scalbn(solution[static_cast<glm::length_t>(k)], -row_exponent_[k]);
    Row lacking{};
    Row error{};
    for (std::size_t k = 0; k < 4; ++k) {
        const double target = std::scalbn(row[static_cast<glm::length_t>(k)], column_exponent_[k]);
        const Bounded residual = bounded_residual_of(scaled_solution, scaled_, k, target);
        for (std::size_t j = 0; j < 4; ++j) {
            lacking[j] += residual.value * inverse_[k][j];
            error[j] += (residual.error + gamma(5) * std::fabs(residual.value)) * std::fabs(inverse_[k][j]);
        }
    }
    double largest = 0.0;
    for (std::size_t j = 0; j < 4; ++j) largest = larger_or_nan(largest, std::fabs(lacking[j]) + error[j]);
    const double remainder = largest * (contraction / (1.0 - contraction));
    glm::dvec4 result(0.0);
    for (std::size_t j = 0; j < 4; ++j) {
        const double bound = 1.001 * (std::fabs(lacking[j]) + error[j] + remainder) + 0x1p-1000;
        result[static_cast<glm::length_t>(j)] = std::scalbn(bound, row_exponent_[j]) + 0x1p-1074;
    }
    return result;
}

inline glm::dmat4 CertifiedInverse::error_of(const glm::dmat4& solution, const glm::dmat4& rows) const noexcept {
    const double r = contraction();
    const glm::dmat4 solved = glm::transpose(solution), given = glm::transpose(rows);
    return glm::transpose(glm::dmat4(error_of_row(solved[0], given[0], r), error_of_row(solved[1], given[1], r),
                                     error_of_row(solved[2], given[2], r), error_of_row(solved[3], given[3], r)));
}

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
