// The planes that the theorem of separating axes asks about, beside the sides and q.

namespace TEXGEN_DETAIL {

// The planes through an edge of the pyramid, where sides f and g meet, and parallel to an axis of the space: with
// coefficients f_k and g_k of that axis, |g_k| f + |f_k| g has none where f_k and g_k have opposite signs. The other
// coefficients are two products of rounded numbers and a sum: 4 u of the terms.
inline void LitForms::add_edge_forms() noexcept {
    for (std::size_t s = 0; s < 2; ++s) {
        for (std::size_t t = 2; t < 4; ++t) {
            const LinearForm& f = forms_[s];
            const LinearForm& g = forms_[t];
            for (std::size_t axis = 0; axis < 3; ++axis) {
                if (!(f.a[axis] < 0.0 ? g.a[axis] > 0.0 : f.a[axis] > 0.0 && g.a[axis] < 0.0)) continue;
                const double of_f = std::fabs(g.a[axis]);
                const double of_g = std::fabs(f.a[axis]);
                LinearForm form{};
                Point error{};
                for (std::size_t j = 0; j < 3; ++j) {
                    form.uses[j] = j != axis && (f.uses[j] || g.uses[j]);
                    if (!form.uses[j]) continue;
                    form.a[j] = of_f * f.a[j] + of_g * g.a[j];
                    error[j] = gamma(5) * (of_f * std::fabs(f.a[j]) + of_g * std::fabs(g.a[j]));
                }
                form.d = of_f * f.d + of_g * g.d;
                set_errors(form, error, gamma(5) * (of_f * std::fabs(f.d) + of_g * std::fabs(g.d)));
                separating_[separating_count_++] = form;
            }
        }
    }
}

// The planes through the apex that have x, y or z alone. alpha T_s + beta T_t + gamma T_q with the cofactors of that
// column of the 3x3 of the rows has no coefficient in the two others, and where alpha s + beta t + gamma has one sign
// at the corners of the region, it has it in all of the pyramid.
inline void LitForms::add_axis_forms() noexcept {
    const auto minor_of = [this](std::size_t k, std::size_t l, std::size_t m, std::size_t n) {
        const double first = rows_[k][m] * rows_[l][n];
        const double second = rows_[k][n] * rows_[l][m];
        return Bounded{first - second, gamma(3) * (std::fabs(first) + std::fabs(second)) + 0x1p-1000};
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t m = (axis + 1) % 3;
        const std::size_t n = (axis + 2) % 3;
        const Bounded cofactor[3] = {minor_of(1, 2, m, n), minor_of(2, 0, m, n), minor_of(0, 1, m, n)};
        const auto dot = [&](double s, double t, double of_q) {
            const double terms[3] = {cofactor[0].value * s, cofactor[1].value * t, cofactor[2].value * of_q};
            const double error = cofactor[0].error * std::fabs(s) + cofactor[1].error * std::fabs(t) +
                                 cofactor[2].error * std::fabs(of_q);
            const double magnitude = std::fabs(terms[0]) + std::fabs(terms[1]) + std::fabs(terms[2]);
            return Bounded{terms[0] + terms[1] + terms[2], 1.001 * error + gamma(5) * magnitude + 0x1p-1000};
        };
        bool is_positive = true;
        bool is_negative = true;
        for (const double s : {side_[0], side_[1]}) {
            for (const double t : {side_[2], side_[3]}) {
                const Bounded corner = dot(s, t, 1.0);
                const bool is_certain = std::fabs(corner.value) >= corner.error && corner.error < 0x1p1000;
                is_positive = is_positive && is_certain && corner.value > 0.0;
                is_negative = is_negative && is_certain && corner.value < 0.0;
            }
        }
        if (is_positive == is_negative) continue;
        const double sign = is_positive ? 1.0 : -1.0;
        const Bounded a = dot(rows_[0][axis], rows_[1][axis], rows_[2][axis]);
        const Bounded d = dot(rows_[0][3], rows_[1][3], rows_[2][3]);
        LinearForm form{};
        form.a[axis] = sign * a.value;
        form.uses[axis] = true;
        form.d = sign * d.value;
        Point error{};
        error[axis] = a.error;
        set_errors(form, error, d.error);
        separating_[separating_count_++] = form;
    }
}

}  // namespace TEXGEN_DETAIL
