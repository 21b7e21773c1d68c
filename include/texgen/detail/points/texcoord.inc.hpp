// The bodies of texcoord.hpp: points in parts that the kernels can read, from one tier to the next.

namespace TEXGEN_DETAIL {

// Copies `count` points from `first` on. Where x, y, z follow one another they are copied together: a load and a store
// for each take twice the time.
template <class Space>
void copy_points(const Positions<Space>& positions, std::size_t first, std::size_t count, float* to) noexcept {
    constexpr std::size_t size = 3 * sizeof(float);
    const float* const x = positions.x();
    if (positions.y() == x + 1 && positions.z() == x + 2) {
        const std::size_t stride = positions.stride_bytes();
        const std::byte* from = reinterpret_cast<const std::byte*>(x) + first * stride;
        for (std::size_t i = 0; i < count; ++i, from += stride) std::memcpy(to + 3 * i, from, size);
    } else {
        for (std::size_t i = 0; i < count; ++i) {
            const glm::vec3 point = positions[first + i];
            std::memcpy(to + 3 * i, &point.x, size);
        }
    }
}

// Calls run(input, part) for parts of the first `count` positions that the kernels can read: as they are, or, where the
// count is no multiple of point_quantum or the layout is none of theirs, copied, and padded with the last point.
template <class Space, class Run>
void for_each_part(const Positions<Space>& positions, std::size_t count, const Run& run) noexcept {
    std::size_t first = 0;
    if (positions.is_planar() || positions.is_interleaved()) {
        first = count / point_quantum * point_quantum;
        if (first != 0)
            run(PointInput{positions.is_interleaved(), positions.x(), positions.y(), positions.z()},
                JobPart{0, first, first});
    }
    float points[3 * copy_size];
    while (first < count) {
        const std::size_t size = count - first < copy_size ? count - first : copy_size;
        const std::size_t whole = (size + point_quantum - 1) / point_quantum * point_quantum;
        copy_points(positions, first, size, points);
        for (std::size_t i = size; i < whole; ++i)
            std::memcpy(points + 3 * i, points + 3 * (size - 1), 3 * sizeof(float));
        run(PointInput{true, points, points + 1, points + 2}, JobPart{first, size, whole});
        first += size;
    }
}

// A job without points and outputs: the forms of these rows over the row of q; one alone is in both places. Other
// members are not initialized: to clear so large a struct takes ten times as long as all else.
inline PointJob point_job(const glm::dmat4& matrix, int row, int numerators, const LitTest& lit,
                          const Tolerance& tolerance) noexcept {
    PointJob job;
    job.numerators = numerators;
    job.interleaved_st = false;
    job.lit = nullptr;
    job.numerator[0] = form(matrix, row);
    job.numerator[1] = form(matrix, row + numerators - 1);
    job.q = form(matrix, 3);
    job.tolerance = accepted(tolerance);
    job.is_certified = false;
    job.ulps = 0;
    lit.copy_to(job.min, job.max);
    return job;
}

// Whether a box says where points are: not with a NaN, or min > max.
inline bool is_ordered(const Box& box) noexcept {
    return box.min.x <= box.max.x && box.min.y <= box.max.y && box.min.z <= box.max.z;
}

inline bool is_inside(const Box& box, const glm::vec3& point) noexcept {
    return box.min.x <= point.x && point.x <= box.max.x && box.min.y <= point.y && point.y <= box.max.y &&
           box.min.z <= point.z && point.z <= box.max.z;
}

// Whether all positions lie in a box. Twelve floats at a time where no gathering is needed, so that to assert it takes no
// longer than the box saves.
template <class Space>
bool are_inside(const Box& box, const Positions<Space>& positions) noexcept {
    std::size_t checked = 0;
    const bool is_planar = positions.is_planar();
    if (positions.size() >= 4 && (is_planar || positions.is_interleaved())) {
        const float* from[] = {positions.x(), positions.y(), positions.z()};
        for (std::size_t j = 0; j < 3 && !is_planar; ++j) from[j] = positions.x() + 4 * j;
        float bounds[2][12];
        for (std::size_t i = 0; i < 12; ++i) {
            const auto axis = static_cast<glm::length_t>(is_planar ? i / 4 : i % 3);
            bounds[0][i] = box.min[axis];
            bounds[1][i] = box.max[axis];
        }
        Float4 min[3], max[3];
        std::memcpy(min, bounds[0], sizeof min);
        std::memcpy(max, bounds[1], sizeof max);
        for (; checked + 4 <= positions.size(); checked += 4) {
            TEXGEN_FOR (std::size_t j = 0; j < 3; ++j) {
                Float4 values;
                std::memcpy(&values, from[j], sizeof values);
                if (!are_between(values, min[j], max[j])) return false;
                from[j] += is_planar ? 4 : 12;
            }
        }
    }
    for (; checked < positions.size(); ++checked)
        if (!is_inside(box, positions[checked])) return false;
    return true;
}

// Sets what follows for a job if all points lie in a box: nothing if one of them may be next to q = 0 or behind.
inline void set_bounds(PointJob& job, const Box& box) noexcept {
    if (!is_ordered(box)) return;
    const glm::dvec3 min = widened(box.min), max = widened(box.max);
    const glm::dvec3 size(larger(-min.x, max.x), larger(-min.y, max.y), larger(-min.z, max.z));
    // Bounds on a form's values at the points of the box, and on the sum of its terms.
    struct Range {
        double least, largest, terms;
    };
    const auto range_of = [&](const PointForm& form) {
        const double x[2] = {form.x * min.x, form.x * max.x};
        const double y[2] = {form.y * min.y, form.y * max.y};
        const double z[2] = {form.z * min.z, form.z * max.z};
        const double terms = terms_at(form, size), error = gamma(5) * terms;
        return Range{form.w + smaller(x[0], x[1]) + smaller(y[0], y[1]) + smaller(z[0], z[1]) - error,
                     form.w + larger(x[0], x[1]) + larger(y[0], y[1]) + larger(z[0], z[1]) + error, terms};
    };
    const auto is_float = [](const PointForm& form) {
        return std::fabs(form.x) + std::fabs(form.y) + std::fabs(form.z) + std::fabs(form.w) < 0x1p127;
    };
    const Range q = range_of(job.q);
    if (!(q.terms < 0x1p1000 && q.least > 0x1p20 * gamma(5) * q.terms)) return;
    const double reciprocal = 1.0 / q.least;
    Range numerator[2];
    job.is_certified = job.tolerance > 0.0 && is_float(job.q);
    for (int k = 0; k < job.numerators; ++k) {
        const PointForm& form = job.numerator[k];
        const Range& s = numerator[k] = range_of(form);
        if (!job.is_certified) continue;
        const double quotient = larger(-s.least, s.largest) * reciprocal * (1.0 + gamma(3));
        const double of_float = all_float.error(s.terms, q.terms, size.x + size.y + size.z + 1.0, q.least, quotient);
        job.is_certified = is_float(form) && of_float <= job.tolerance;
    }
    if (job.is_certified) return;
    double ulps = 0.0;
    for (int k = 0; k < job.numerators; ++k) {
        const Range& s = numerator[k];
        // Relative to itself a quotient errs by e_s / |s| + e_q / q and four roundings, and its ulp is 2^-53 of it or
        // more.
        const double least = larger(s.least, -s.largest);  // negative where the sign changes
        const double share = (s.terms / least + q.terms * reciprocal) * (gamma(5) * (1.0 + gamma(2)));
        ulps = larger(ulps, least > 0x1p-124 * q.largest ? share * 0x1.01p53 + 4.0 : quick_ulps);
    }
    // Products of two such q are in range, and quotients are no subnormal floats.
    if (ulps < quick_ulps && q.least > 0x1p-240 && q.terms < 0x1p240) job.ulps = mask_of_ulps(ulps);
}

inline namespace TEXGEN_BUILD {

// Projects positions from `first` on, one by one.
template <class Space>
void project_each(const Positions<Space>& positions, std::size_t first, const PointJob& job,
                  const PointOutputs& out) noexcept {
    const auto alone = [](const PointForm& form) -> PointForm {
        return {read_alone(form.x), read_alone(form.y), read_alone(form.z), read_alone(form.w)};
    };
    const FormPair numerators(alone(job.numerator[0]), alone(job.numerator[1]));
    const PointForm q_form = alone(job.q);
    for (std::size_t i = first; i < positions.size(); ++i) {
        const std::optional<glm::vec2> divided = divide_point(numerators, q_form, widened(positions[i]));
        const glm::vec2 value = divided ? *divided : glm::vec2(0.0f);
        if (out.st != nullptr) std::memcpy(out.st + 2 * i, &value.x, 2 * sizeof(float));
        for (std::size_t k = 0; k < 2; ++k)
            if (out.coordinate[k] != nullptr) out.coordinate[k][i] = value[static_cast<glm::length_t>(k)];
        if (out.lit == nullptr) continue;
        if (job.numerators == 2) {
            out.lit[i] = divided && is_inside(value.x, value.y, job.min, job.max) ? 1.0f : 0.0f;
        } else if (!(value.x >= out.r_min && value.x <= out.r_max)) {
            out.lit[i] = 0.0f;
        }
    }
}

// Below this tolerance floats serve few coordinates in [0, 1], and are not tried: a quotient of about 1 errs by 12 u.
inline constexpr double least_in_float = 16.0 * unit_roundoff_float;

template <class Space>
void project_all(const Positions<Space>& positions, PointJob& job, const PointOutputs& out) noexcept {
    // This many points beyond whole vectors take less time one by one than it takes to prepare the kernel.
    constexpr std::size_t few = 5;
    const std::size_t beyond = positions.size() % point_quantum;
    const std::size_t count = positions.size() - (beyond <= few ? beyond : 0);
    if (count != positions.size()) project_each(positions, count, job, out);
    if (count == 0) return;
    const PointKernels& kernels = chosen<PointKernels>();
    set_bounds(job, positions.bounds());
    for_each_part(positions, count, [&](const PointInput& input, const JobPart& part) {
        static_cast<PointInput&>(job) = input;
        run_part(job, out, part, [&](const PointJob& points) {
            const bool is_in_float = points.is_certified || points.tolerance > least_in_float;
            fill_blocks(is_in_float ? kernels.fill_within : kernels.fill_exact, points, 0, project_one);
        });
    });
}

template <class Space>
void generate_all(const glm::dmat4& matrix, const Positions<Space>& positions, float* const (&out)[4],
                  float* strq) noexcept {
    GenerateJob job;
    for (int k = 0; k < 4; ++k) job.form[k] = form(matrix, k);
    const std::size_t size = positions.size();
    if (size >= point_quantum && (positions.is_interleaved() || positions.is_planar())) {
        static_cast<PointInput&>(job) = {positions.is_interleaved(), positions.x(), positions.y(), positions.z()};
        job.count = size;
        job.strq = strq;
        for (std::size_t k = 0; k < 4; ++k) job.out[k] = out[k];
        return chosen<PointKernels>().generate(job);
    }
    for_each_part(positions, size, [&](const PointInput& input, const JobPart& part) {
        const auto [first, count, whole] = part;
        float buffer[4 * copy_size];
        static_cast<PointInput&>(job) = input;
        job.count = whole;
        job.strq = strq == nullptr ? nullptr : buffer;
        for (std::size_t k = 0; k < 4; ++k) job.out[k] = out[k] == nullptr ? nullptr : buffer + k * copy_size;
        chosen<PointKernels>().generate(job);
        if (strq != nullptr) std::memcpy(strq + 4 * first, buffer, 4 * count * sizeof(float));
        for (std::size_t k = 0; k < 4; ++k)
            if (out[k] != nullptr) std::memcpy(out[k] + first, job.out[k], count * sizeof(float));
    });
}

}  // namespace TEXGEN_BUILD
}  // namespace TEXGEN_DETAIL

namespace TEXGEN_NAMESPACE {

template <class Space>
Positions<Space> Positions<Space>::within(const Box& box) const noexcept {
    TEXGEN_ASSERT(!detail::is_ordered(box) || detail::are_inside(box, *this));
    Positions result = *this;
    result.bounds_ = box;
    return result;
}

template <class Space>
glm::dvec4 generate_error_bound(const Transform<Texture, Space>& texture_from_space,
                                const Positions<Space>& positions) noexcept {
    glm::dvec4 largest(0.0);
    for (glm::length_t k = 0; k < 4; ++k) {
        const detail::PointForm form = detail::form(texture_from_space.matrix(), k);
        for (std::size_t i = 0; i < positions.size(); ++i) {
            const detail::Bounded value = detail::value_at(form, detail::widened(positions[i]));
            const double bound = value.error + detail::half_ulp(std::fabs(value.value) + 2.0 * value.error);
            largest[k] = detail::larger_or_nan(largest[k], bound);
        }
    }
    return largest;
}

template <class Space>
glm::dvec2 project_error_bound(const Transform<Texture, Space>& texture_from_space, const Positions<Space>& positions,
                               const Tolerance& tolerance) noexcept {
    const glm::dmat4& matrix = texture_from_space.matrix();
    const detail::PointForm form[2] = {detail::form(matrix, 0), detail::form(matrix, 1)};
    const detail::PointForm q_form = detail::form(matrix, 3);
    const double accepted = detail::accepted(tolerance);
    const auto bound_of_float = [&](const detail::FloatDivision& division, std::size_t k, const glm::dvec3& size,
                                    double least_q, double quotient) {
        return division.error(detail::terms_at(form[k], size), detail::terms_at(q_form, size),
                              size.x + size.y + size.z + 1.0, least_q, quotient);
    };
    // Calls visit(|v|, the least q, the largest quotients) for each position; false where one has no bounds.
    const auto visit_all = [&](const auto& visit) {
        for (std::size_t i = 0; i < positions.size(); ++i) {
            const glm::dvec3 v = detail::widened(positions[i]);
            const detail::Bounded q = detail::accurately_at(q_form, v);
            if (!(q.error < 0x1p1000)) return false;
            const double least_q = q.value > 0.0 ? q.value - q.error : 0.0;
            double quotient[2] = {};
            for (std::size_t k = 0; k < 2 && least_q > 0.0; ++k) {
                const detail::Bounded s = detail::accurately_at(form[k], v);
                quotient[k] = (std::fabs(s.value) + s.error) / least_q * (1.0 + detail::gamma(4));
            }
            visit(glm::dvec3(std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)), least_q, quotient);
        }
        return true;
    };
    glm::dvec3 size(0.0);
    double least_of_q = detail::largest_q_in_front, largest_quotient[2] = {};
    const bool are_bounded = visit_all([&](const glm::dvec3& v, double least_q, const double(&quotient)[2]) {
        for (glm::length_t j = 0; j < 3; ++j) size[j] = detail::larger(size[j], v[j]);
        least_of_q = detail::smaller(least_of_q, least_q);
        for (std::size_t k = 0; k < 2; ++k)
            largest_quotient[k] = detail::larger_or_nan(largest_quotient[k], quotient[k]);
    });
    if (!are_bounded) return glm::dvec2(detail::infinity);
    // Where these bounds certify all blocks with room, errors are those of a point's own terms. Else some may be
    // divided about another point: differences are at most twice, and terms as much as, those of the farthest.
    const double q_terms = detail::terms_at(q_form, size);
    bool are_in_front = least_of_q > 2.0 * detail::least_q_in_front && q_terms < 0.5 * detail::largest_terms_in_float &&
                        detail::all_float.form_error * q_terms < 0.04 * least_of_q;
    for (std::size_t k = 0; k < 2; ++k)
        are_in_front =
            are_in_front && detail::terms_at(form[k], size) < 0.5 * detail::largest_terms_in_float &&
            1.1 * bound_of_float(detail::all_float, k, size, 0.9 * least_of_q, largest_quotient[k] + accepted) <
                accepted;
    constexpr double least_difference = 0x1p-104;  // of floats, where a subnormal one is 0, over form_error
    glm::dvec2 largest(0.0);
    visit_all([&](const glm::dvec3& v, double least_q, const double(&quotient)[2]) {
        for (std::size_t k = 0; k < 2 && least_q > 0.0; ++k) {
            // Of all ways to divide, those in float err most.
            const double of_float = are_in_front ? bound_of_float(detail::all_float, k, v, least_q, quotient[k])
                                                 : bound_of_float(detail::about_point, k, size * 3.0 + least_difference,
                                                                  least_q, quotient[k]);
            const double bound = detail::larger(detail::smaller(of_float, accepted), detail::half_ulp(quotient[k]));
            double& of_all = largest[static_cast<glm::length_t>(k)];
            of_all = detail::larger_or_nan(of_all, bound);
        }
    });
    return largest;
}

inline namespace TEXGEN_BUILD {

template <class Space>
void generate(const Transform<Texture, Space>& texture_from_space, const Positions<Space>& positions,
              const std::span<glm::vec4>& strq) noexcept {
    TEXGEN_ASSERT(strq.size() == positions.size());
    if (strq.empty() || strq.size() != positions.size()) return;
    detail::generate_all(texture_from_space.matrix(), positions, {}, &strq[0].x);
}

template <class Space>
void generate(const Transform<Texture, Space>& texture_from_space, const Positions<Space>& positions,
              const HomogeneousTexcoords& out) noexcept {
    const auto array = [&](const std::span<float>& output) { return detail::array_of(output, positions.size()); };
    float* const arrays[4] = {array(out.s), array(out.t), array(out.r), array(out.q)};
    for (const float* const any : arrays)
        if (any != nullptr) return detail::generate_all(texture_from_space.matrix(), positions, arrays, nullptr);
}

template <class Space>
void project(const Transform<Texture, Space>& texture_from_space, const Positions<Space>& positions,
             const TextureRegion& region, const Texcoords& out, const Tolerance& tolerance) noexcept {
    const glm::dmat4& matrix = texture_from_space.matrix();
    const detail::LitTest lit(region);
    detail::for_each_group(out, positions.size(), lit,
                           [&](int row, int numerators, const detail::PointOutputs& outputs) {
                               detail::PointJob job = detail::point_job(matrix, row, numerators, lit, tolerance);
                               detail::project_all(positions, job, outputs);
                           });
}

template <class Space>
void project(const Transform<Texture, Space>& texture_from_space, const Positions<Space>& positions,
             const std::span<glm::vec2>& st, const Tolerance& tolerance) noexcept {
    TEXGEN_ASSERT(st.size() == positions.size());
    if (st.empty() || st.size() != positions.size()) return;
    const detail::LitTest unused(whole_texture());
    detail::PointJob job = detail::point_job(texture_from_space.matrix(), 0, 2, unused, tolerance);
    detail::project_all(positions, job, {{}, nullptr, &st[0].x});
}

template <class Space>
std::optional<glm::vec2> project(const Transform<Texture, Space>& texture_from_space,
                                 const Position<Space>& position) noexcept {
    const glm::dmat4& matrix = texture_from_space.matrix();
    return detail::divide_point({detail::form(matrix, 0), detail::form(matrix, 1)}, detail::form(matrix, 3),
                                detail::widened(position.point));
}

}  // namespace TEXGEN_BUILD
}  // namespace TEXGEN_NAMESPACE
