// The planes that the theorem of separating axes asks about, beside the sides, q and the limits of depth.

namespace TEXGEN_DETAIL {

// Further forms that are >= 0 wherever all of a slide's are, each a combination of those with weights that are exactly >= 0.
// Where one of them is negative over all of a convex body, nothing of the body is lit.
class SeparatingForms {
public:
    // Those that can be negative over a body that holds a point where only the `dark` forms may be below 0; a bit each.
    explicit SeparatingForms(const LitForms& forms, std::uint32_t dark = ~std::uint32_t{}) noexcept
        : lit_(forms), dark_(dark) {
        if (dark == 0) return;
        constexpr std::size_t s = 0, t = 2, r = LitForms::q + 1;
        add_edge_forms(s, t);
        add_axis_forms();
        if (forms.count() == forms_without_depth) return;
        add_edge_forms(s, r);
        add_edge_forms(t, r);
        for (std::size_t f = s; f < s + 2; ++f)
            for (std::size_t g = t; g < t + 2; ++g)
                for (std::size_t h = r; h < r + 2; ++h) add_vertex_forms(f, g, h);
    }

    // A pointer and a count: the constraints of a span's constructor would take every user longer to compile than all of
    // this header.
    const LinearForm* data() const noexcept { return forms_.data(); }
    std::size_t size() const noexcept { return size_; }

private:
    bool is_dark(std::size_t k) const noexcept { return (dark_ >> k & 1u) != 0; }

    // sum of weight[i] * form[i], and the rounding of that: of each coefficient, a product and the sums.
    template <std::size_t N>
    void add(const std::size_t (&form)[N], const double (&weight)[N], std::size_t but_axis) noexcept {
        constexpr double rounding = gamma(3 + static_cast<int>(N));
        LinearForm& sum = forms_[size_++];
        sum = {};
        Point error{};
        double error_of_d = 0.0;
        for (std::size_t i = 0; i < N; ++i) {
            const LinearForm one = lit_[form[i]];
            for (std::size_t j = 0; j < 3; ++j) {
                if (j == but_axis) continue;
                sum.uses[j] = sum.uses[j] || one.uses[j];
                sum.a[j] += weight[i] * one.a[j];
                error[j] += rounding * std::fabs(weight[i] * one.a[j]);
            }
            sum.d += weight[i] * one.d;
            error_of_d += rounding * std::fabs(weight[i] * one.d);
        }
        set_errors(sum, error, error_of_d);
    }

    void add_edge_forms(std::size_t first, std::size_t second) noexcept;
    void add_axis_forms() noexcept;
    void add_vertex_forms(std::size_t f, std::size_t g, std::size_t h) noexcept;

    const LitForms& lit_;
    std::uint32_t dark_;
    std::size_t size_ = 0;
    std::array<LinearForm, 3 * 4 * 3 + 3 + 3 * 8> forms_;  // of edges, of the apex and of vertices
};

// The planes through an edge, where forms f and g of two coordinates meet, and parallel to an axis of the space: with
// coefficients f_k and g_k of that axis, |g_k| f + |f_k| g has none where f_k and g_k have opposite signs.
inline void SeparatingForms::add_edge_forms(std::size_t first, std::size_t second) noexcept {
    for (std::size_t f = first; f < first + 2; ++f) {
        for (std::size_t g = second; g < second + 2; ++g) {
            if (!is_dark(f) && !is_dark(g)) continue;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const double of_f = lit_.a(g, axis);
                const double of_g = lit_.a(f, axis);
                if (!(of_f < 0.0 ? of_g > 0.0 : of_f > 0.0 && of_g < 0.0)) continue;
                add<2>({f, g}, {std::fabs(of_f), std::fabs(of_g)}, axis);
            }
        }
    }
}

// The planes through a vertex, where three forms meet, and across an axis: as f, g and h have no other point in common, the
// products across g x h, h x f and f x g are their weights, where they have one sign. Rounded weights serve as well.
inline void SeparatingForms::add_vertex_forms(std::size_t f, std::size_t g, std::size_t h) noexcept {
    if (!is_dark(f) && !is_dark(g) && !is_dark(h)) return;
    const auto across = [this](std::size_t k, std::size_t l, std::size_t m, std::size_t n) {
        return lit_.a(k, m) * lit_.a(l, n) - lit_.a(k, n) * lit_.a(l, m);
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t m = (axis + 1) % 3;
        const std::size_t n = (axis + 2) % 3;
        const double weight[3] = {across(g, h, m, n), across(h, f, m, n), across(f, g, m, n)};
        const bool any_is_positive = weight[0] > 0.0 || weight[1] > 0.0 || weight[2] > 0.0;
        const bool any_is_negative = weight[0] < 0.0 || weight[1] < 0.0 || weight[2] < 0.0;
        if (any_is_positive == any_is_negative) continue;
        add<3>({f, g, h}, {std::fabs(weight[0]), std::fabs(weight[1]), std::fabs(weight[2])}, 3);
    }
}

// The planes through the apex that have x, y or z alone. alpha T_s + beta T_t + gamma T_q with the cofactors of that
// column of the 3x3 of the rows has no coefficient in the two others, and where alpha s + beta t + gamma has one sign
// at the corners of the region, it has it in all of the pyramid.
inline void SeparatingForms::add_axis_forms() noexcept {
    using Row = LitForms::Row;
    const Row row_s = lit_.row(0);
    const Row row_t = lit_.row(1);
    const Row row_q = lit_.row(3);
    const auto minor_of = [](const Row& k, const Row& l, std::size_t m, std::size_t n) {
        const double first = k[m] * l[n];
        const double second = k[n] * l[m];
        return Bounded{first - second, gamma(3) * (std::fabs(first) + std::fabs(second)) + 0x1p-1000};
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t m = (axis + 1) % 3;
        const std::size_t n = (axis + 2) % 3;
        const Bounded cofactor[3] = {minor_of(row_t, row_q, m, n), minor_of(row_q, row_s, m, n),
                                     minor_of(row_s, row_t, m, n)};
        const auto dot = [&](double s, double t, double of_q) {
            const double terms[3] = {cofactor[0].value * s, cofactor[1].value * t, cofactor[2].value * of_q};
            const double error = cofactor[0].error * std::fabs(s) + cofactor[1].error * std::fabs(t) +
                                 cofactor[2].error * std::fabs(of_q);
            const double magnitude = std::fabs(terms[0]) + std::fabs(terms[1]) + std::fabs(terms[2]);
            return Bounded{terms[0] + terms[1] + terms[2], 1.001 * error + gamma(5) * magnitude + 0x1p-1000};
        };
        bool is_positive = true;
        bool is_negative = true;
        for (const double s : {lit_.side(0), lit_.side(1)}) {
            for (const double t : {lit_.side(2), lit_.side(3)}) {
                const Bounded corner = dot(s, t, 1.0);
                const bool is_certain = std::fabs(corner.value) >= corner.error && corner.error < 0x1p1000;
                is_positive = is_positive && is_certain && corner.value > 0.0;
                is_negative = is_negative && is_certain && corner.value < 0.0;
            }
        }
        if (is_positive == is_negative) continue;
        const double sign = is_positive ? 1.0 : -1.0;
        const Bounded a = dot(row_s[axis], row_t[axis], row_q[axis]);
        const Bounded d = dot(row_s[3], row_t[3], row_q[3]);
        LinearForm form{};
        form.a[axis] = sign * a.value;
        form.uses[axis] = true;
        form.d = sign * d.value;
        Point error{};
        error[axis] = a.error;
        set_errors(form, error, d.error);
        forms_[size_++] = form;
    }
}

}  // namespace TEXGEN_DETAIL
