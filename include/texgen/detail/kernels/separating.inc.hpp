// The planes that the theorem of separating axes asks about, beside the sides, q and the limits of depth: made, a lane
// a form, and asked about one box or many. Included by kernels.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// Forms of a slide, a lane each: f of each pair or three, or g, or h.
struct FormColumns {
    double a[3][2 * form_lanes], d[2 * form_lanes];

    void put(const FormLanes& forms, std::size_t k, std::size_t lane) noexcept {
        for (std::size_t j = 0; j < 3; ++j) a[j][lane] = forms.a[j][k];
        d[lane] = forms.d[k];
    }
};

// Adds sums of N forms with weights >= 0, where they make a plane. Each coefficient is rounded, as are its product and
// the sums, and those of a box; no a is above 2. A coefficient stays 0 if no form has it, or it is that of but_axis.
template <std::size_t N>
TEXGEN_INLINE void add_plane(SeparatingPlanes& planes, const FormColumns* const (&form)[N], const Doubles (&weight)[N],
                             const LongWords& is_plane, std::size_t but_axis, std::size_t i) noexcept {
    if (!any(is_plane)) return;
    constexpr double rounding = 1.001 * gamma(11 + static_cast<int>(N));
    for (std::size_t j = 0; j < 3; ++j) {
        Doubles sum{};
        if (j != but_axis) {
            Doubles size{};
            TEXGEN_FOR (std::size_t k = 0; k < N; ++k) {
                const auto a = load<Doubles>(form[k]->a[j] + i);
                sum = sum + weight[k] * a;
                size = size + magnitude(a);
            }
            sum = sum + where(greater(size, 0.0), Doubles{} + 0x1p-1000);
        }
        store(planes.a[j] + planes.count, sum);
    }
    Doubles d{}, size{}, all_weights{};
    TEXGEN_FOR (std::size_t k = 0; k < N; ++k) {
        const auto of_form = load<Doubles>(form[k]->d + i);
        d = d + weight[k] * of_form;
        size = size + weight[k] * magnitude(of_form);
        all_weights = all_weights + weight[k];
    }
    store(planes.d + planes.count, select(is_plane, d + (size * rounding + 0x1p-999), Doubles{} + infinity));
    store(planes.error + planes.count, all_weights * (2.0 * rounding) + 0x1p-999);
    planes.count += at_once;
}

// The planes through an edge, where forms f and g of two coordinates meet, and parallel to an axis of the space: with
// coefficients f_k and g_k of that axis, |g_k| f + |f_k| g does not use the axis where f_k and g_k have opposite signs.
template <class CompiledWhereCalled = void>
TEXGEN_INLINE void add_edges(SeparatingPlanes& planes, const FormLanes& forms, std::size_t form_count) noexcept {
    const std::size_t edges = edge_count(form_count);
    FormColumns f{}, g{};  // what fills a vector is 0, and no plane
    for (std::size_t i = 0; i < edges; ++i) {
        f.put(forms, first_of_edge[i], i);
        g.put(forms, second_of_edge[i], i);
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < edges; i += at_once) {
            const auto a = load<Doubles>(f.a[axis] + i), b = load<Doubles>(g.a[axis] + i);
            const LongWords are_opposite =
                (greater(a, 0.0) & greater(0.0 - b, 0.0)) | (greater(0.0 - a, 0.0) & greater(b, 0.0));
            add_plane<2>(planes, {&f, &g}, {magnitude(b), magnitude(a)}, are_opposite, axis, i);
        }
    }
}

// The planes through a vertex, where forms f, g and h meet, and perpendicular to an axis: the weights are the
// components along it of g x h, h x f and f x g, where these have one sign. Rounded ones serve, too.
template <class CompiledWhereCalled = void>
TEXGEN_INLINE void add_vertices(SeparatingPlanes& planes, const FormLanes& forms) noexcept {
    FormColumns f, g, h;
    for (std::size_t i = 0; i < 8; ++i) {
        f.put(forms, i / 4, i);
        g.put(forms, 2 + i / 2 % 2, i);
        h.put(forms, form_of_q + 1 + i % 2, i);
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t m = (axis + 1) % 3, n = (axis + 2) % 3;
        for (std::size_t i = 0; i < 8; i += at_once) {
            const auto across = [&](const FormColumns& k, const FormColumns& l) {
                return load<Doubles>(k.a[m] + i) * load<Doubles>(l.a[n] + i) -
                       load<Doubles>(k.a[n] + i) * load<Doubles>(l.a[m] + i);
            };
            const Doubles weight[3] = {across(g, h), across(h, f), across(f, g)};
            const Doubles least = minimum(minimum(weight[0], weight[1]), weight[2]);
            const Doubles largest = maximum(maximum(weight[0], weight[1]), weight[2]);
            const LongWords have_one_sign = greater(0.0 - least, 0.0) ^ greater(largest, 0.0);
            add_plane<3>(planes, {&f, &g, &h}, {magnitude(weight[0]), magnitude(weight[1]), magnitude(weight[2])},
                         have_one_sign, 3, i);
        }
    }
}

// The planes through the apex that use x, y or z alone, a lane each. alpha T_s + beta T_t + gamma T_q, with the
// cofactors of that column in the 3x3 of the rows, has no coefficient in the two others; where alpha s + beta t + gamma
// has one sign at the corners of the region, it has that in all of the pyramid. Where a side of the region is infinite,
// alpha, or beta, has to have the sign that keeps it.
template <class CompiledWhereCalled = void>
TEXGEN_INLINE void add_axes(SeparatingPlanes& planes, const glm::dmat4& matrix, const double* side) noexcept {
    constexpr double is_axis[3][form_lanes] = {{1.0}, {0.0, 1.0}, {0.0, 0.0, 1.0}};
    constexpr double is_any_axis[form_lanes] = {1.0, 1.0, 1.0};
    constexpr glm::length_t coordinates[3] = {0, 1, 3};
    const double ends[3][2] = {{side[0], side[1]}, {side[2], side[3]}, {1.0, 1.0}};
    // Rows s, t and q, again and again, so that the axes which follow one can be read as well.
    double again[3][form_lanes + 4];
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t first = 0; first < form_lanes + 4; first += 3)
            for (std::size_t j = 0; j < 3; ++j)
                again[k][first + j] = matrix[static_cast<glm::length_t>(j)][coordinates[k]];
    for (std::size_t i = 0; i < 3; i += at_once) {
        Doubles row[3][3];  // the coefficient of an axis, and of the two that follow it
        TEXGEN_FOR (std::size_t k = 0; k < 3; ++k)
            for (std::size_t j = 0; j < 3; ++j) row[k][j] = load<Doubles>(again[k] + i + j);
        Doubles cofactor[3], error[3];
        TEXGEN_FOR (std::size_t k = 0; k < 3; ++k) {
            const std::size_t f = (k + 1) % 3, g = (k + 2) % 3;
            const Doubles first = row[f][1] * row[g][2], second = row[f][2] * row[g][1];
            cofactor[k] = first - second;
            error[k] = (magnitude(first) + magnitude(second)) * gamma(3);
        }
        const auto bound = [&](const auto& s, const auto& t, const auto& q) {
            return (error[0] * s + error[1] * t + error[2] * q) * 1.001 +
                   (magnitude(cofactor[0]) * s + magnitude(cofactor[1]) * t + magnitude(cofactor[2]) * q) * gamma(13) +
                   0x1p-1000;
        };
        // The least and the largest of each cofactor times s, t or 1, between its two sides, with their errors.
        Doubles least = Doubles{} - 0x1p-999, largest = Doubles{} + 0x1p-999;
        for (std::size_t k = 0; k < 3; ++k) {
            const bool has_side = ends[k][0] > -infinity || ends[k][1] < infinity;
            Doubles low = Doubles{} + (has_side ? infinity : 0.0), high = low * -1.0;
            for (std::size_t j = 0; j < 2; ++j) {
                const double size = std::fabs(ends[k][j]);
                if (size < infinity) {
                    const Doubles product = cofactor[k] * ends[k][j];
                    const Doubles margin = error[k] * (1.001 * size) + magnitude(product) * gamma(13);
                    low = minimum(product - margin, low);
                    high = maximum(product + margin, high);
                } else {
                    const Doubles growth = cofactor[k] * (j == 0 ? -1.0 : 1.0);
                    low = select(at_most(error[k], growth), low, Doubles{} - infinity);
                    high = select(at_most(error[k], 0.0 - growth), high, Doubles{} + infinity);
                }
            }
            least = least + low;
            largest = largest + high;
        }
        const LongWords is_positive = greater(least, 0.0);
        const LongWords is_plane =
            (is_positive | greater(0.0 - largest, 0.0)) & are_nonzero(load<Doubles>(is_any_axis + i));
        const Doubles sign = select(is_positive, Doubles{} + 1.0, Doubles{} - 1.0);

        const Doubles a =
            (cofactor[0] * row[0][0] + cofactor[1] * row[1][0] + cofactor[2] * row[2][0]) * sign + 0x1p-1000;
        const Doubles d = (cofactor[0] * matrix[3].x + cofactor[1] * matrix[3].y + cofactor[2] * matrix[3].w) * sign;
        const Doubles error_d = bound(std::fabs(matrix[3].x), std::fabs(matrix[3].y), std::fabs(matrix[3].w));
        for (std::size_t j = 0; j < 3; ++j) store(planes.a[j] + planes.count, a * load<Doubles>(is_axis[j] + i));
        store(planes.d + planes.count, select(is_plane, d + error_d, Doubles{} + infinity));
        store(planes.error + planes.count, bound(magnitude(row[0][0]), magnitude(row[1][0]), magnitude(row[2][0])));
        planes.count += at_once;
    }
}

template <class CompiledWhereCalled = void>
void make_separating_planes(const FormLanes& forms, const glm::dmat4& matrix, const double* side,
                            std::size_t form_count, SeparatingPlanes& planes) noexcept {
    planes.count = 0;
    add_edges(planes, forms, form_count);
    add_axes(planes, matrix, side);
    if (form_count == max_forms) add_vertices(planes, forms);
}

// Whether a plane separates a box. Nothing is certain of a plane that uses an infinite coordinate.
template <class CompiledWhereCalled = void>
bool is_separated(const SeparatingPlanes& planes, const float* box_min, const float* box_max) noexcept {
    double min[3], max[3];
    double size = 0.0;
    for (std::size_t j = 0; j < 3; ++j) {
        min[j] = widened(box_min[j]);
        max[j] = widened(box_max[j]);
        const bool is_bounded = larger(-min[j], max[j]) < infinity;
        if (!is_bounded) max[j] = -(min[j] = -infinity);
        size += is_bounded ? larger(-min[j], max[j]) : 0.0;
    }
    LongWords are_negative{};
    for (std::size_t k = 0; k < planes.count; k += at_once) {
        Doubles largest = load<Doubles>(planes.d + k) + load<Doubles>(planes.error + k) * size;
        TEXGEN_FOR (std::size_t j = 0; j < 3; ++j) {
            const auto a = load<Doubles>(planes.a[j] + k);
            const Doubles vertex = select(greater(a, 0.0), Doubles{} + max[j], Doubles{} + min[j]);
            largest = select(are_nonzero(a), largest + vertex * a, largest);
        }
        are_negative = are_negative | greater(0.0 - largest, 0.0);
    }
    return any(are_negative);
}

// The same for a box in each lane, given as rows of min and max.
TEXGEN_INLINE LongWords are_separated(const SeparatingPlanes& planes, const Doubles (&box)[8]) noexcept {
    Doubles min[3], max[3];
    Doubles size{};
    TEXGEN_FOR (std::size_t j = 0; j < 3; ++j) {
        const Doubles of_axis = maximum(0.0 - box[j], box[3 + j]);
        const LongWords is_bounded = greater(Doubles{} + infinity, of_axis);
        min[j] = select(is_bounded, box[j], Doubles{} - infinity);
        max[j] = select(is_bounded, box[3 + j], Doubles{} + infinity);
        size = size + where(is_bounded, of_axis);
    }
    Doubles least{};
    for (std::size_t k = 0; k < planes.count; ++k) {
        if (!(planes.d[k] < infinity)) continue;
        Doubles largest = planes.d[k] + size * planes.error[k];
        TEXGEN_FOR (std::size_t j = 0; j < 3; ++j)
            if (const double a = planes.a[j][k]; a != 0.0) largest = largest + (a > 0.0 ? max : min)[j] * a;
        least = minimum(largest, least);
    }
    return greater(Doubles{}, least);
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
