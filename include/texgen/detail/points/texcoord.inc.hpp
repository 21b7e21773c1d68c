// The bodies of texcoord.hpp: points in parts that the kernels can read, from one tier to the next.

namespace TEXGEN_DETAIL {

// Copies `count` points from `first` on. Where x, y, z follow one another, they go together: a load and a store for each
// take twice the time.
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

// Calls run(input, part) for parts of the positions that the kernels can read: as they are, or, where the count is no
// multiple of point_quantum or the layout is none of theirs, copied, and padded with the last point.
template <class Space, class Run>
void for_each_part(const Positions<Space>& positions, const Run& run) noexcept {
    const std::size_t count = positions.size();
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

// A job without points: the forms of these rows over the row of q.
inline PointJob point_job(const glm::dmat4& matrix, int row, int numerators, const LitTest& lit,
                          Tolerance tolerance) noexcept {
    PointJob job{};
    job.numerators = numerators;
    for (int k = 0; k < numerators; ++k) job.numerator[k] = form(matrix, row + k);
    job.q = form(matrix, 3);
    job.tolerance = accepted(tolerance);
    lit.copy_to(job.min, job.max);
    return job;
}

// Whether a box is a word on points: a NaN is none.
inline bool is_word(const Box& box) noexcept {
    return box.min.x <= box.max.x && box.min.y <= box.max.y && box.min.z <= box.max.z;
}

inline bool is_inside(const Box& box, const glm::vec3& point) noexcept {
    return box.min.x <= point.x && point.x <= box.max.x && box.min.y <= point.y && point.y <= box.max.y &&
           box.min.z <= point.z && point.z <= box.max.z;
}

// What it makes of a job that all points lie in a box: nothing where one may be next to q = 0 or behind.
inline void take_bounds(PointJob& job, const Box& box) noexcept {
    if (!is_word(box)) return;
    const glm::dvec3 min = widened(box.min), max = widened(box.max);
    const glm::dvec3 size(larger(-min.x, max.x), larger(-min.y, max.y), larger(-min.z, max.z));
    // A form's values at the points of the box, and the sum of its terms.
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
    job.is_certified = is_float(job.q);
    double ulps = 0.0;
    for (int k = 0; k < job.numerators; ++k) {
        const PointForm& form = job.numerator[k];
        const Range s = range_of(form);
        const double quotient = larger(-s.least, s.largest) / q.least * (1.0 + gamma(2));
        const double of_float = all_float.error(s.terms, q.terms, size.x + size.y + size.z + 1.0, q.least, quotient);
        job.is_certified = job.is_certified && is_float(form) && of_float <= job.tolerance;
        // Of itself a quotient errs by e_s / |s| + e_q / q and four roundings, and an ulp of it is at least 2^-53 of
        // it.
        const double least = larger(s.least, -s.largest);  // negative where the sign changes
        const double share = (s.terms / least + q.terms / q.least) * gamma(5);
        ulps = larger(ulps, least > 0x1p-124 * q.largest ? share * 0x1.01p53 + 4.0 : quick_ulps);
    }
    // Products of two such q are in range, and quotients are no subnormal floats.
    if (ulps < quick_ulps && q.least > 0x1p-240 && q.terms < 0x1p240) job.ulps = mask_of_ulps(ulps);
}

inline namespace TEXGEN_BUILD {

// Points begin to end of a job: in vectors; what those cannot decide point by point.
inline void project_exact(const PointKernels& kernels, PointJob& job, std::size_t begin, std::size_t end) noexcept {
    job.count = end;
    fill_blocks(kernels.fill_exact, job, begin, project_one);
}

// Points begin to end by a kernel that stops at a block whose error is not certified to be inside the tolerance. Such a
// block has company: `otherwise` gets more points after each failure, until the kernel is tried again.
void project_within(auto kernel, PointJob& job, std::size_t begin, std::size_t end, const auto& otherwise) noexcept {
    std::size_t pause = float_block;
    for (std::size_t i = begin; i < end;) {
        job.count = end;
        i = kernel(job, i);
        pause = pause < (end - begin) / 8 ? 8 * pause : end - begin;
        const std::size_t resume = pause < end - i ? i + pause : end;
        if (i < end) otherwise(job, i, resume);
        i = resume;
    }
}

// By tolerance: all_float, else float_divided, else exact.
inline void project_job(const PointKernels& kernels, PointJob& points) noexcept {
    const auto exactly = [&kernels](PointJob& job, std::size_t begin, std::size_t end) {
        project_exact(kernels, job, begin, end);
    };
    if (points.tolerance == 0.0) return exactly(points, 0, points.count);
    if (points.is_certified) return static_cast<void>(kernels.fill_all_float(points, 0));
    const auto float_divided = [&](PointJob& job, std::size_t begin, std::size_t end) {
        project_within(kernels.fill_float_divided, job, begin, end, exactly);
    };
    project_within(kernels.fill_all_float, points, 0, points.count, float_divided);
}

template <class Space>
void project_all(const Positions<Space>& positions, PointJob& job, const PointOutputs& out) noexcept {
    const PointKernels& kernels = chosen<PointKernels>();
    take_bounds(job, positions.bounds());
    for_each_part(positions, [&](const PointInput& input, const JobPart& part) {
        static_cast<PointInput&>(job) = input;
        run_part(job, out, part, [&](PointJob& points) { project_job(kernels, points); });
    });
}

template <class Space>
void generate_all(const glm::dmat4& matrix, const Positions<Space>& positions, float* const (&out)[4],
                  float* strq) noexcept {
    GenerateJob job{};
    for (int k = 0; k < 4; ++k) job.form[k] = form(matrix, k);
    for_each_part(positions, [&](const PointInput& input, const JobPart& job_part) {
        const auto [first, count, whole] = job_part;
        GenerateJob part = job;
        static_cast<PointInput&>(part) = input;
        part.count = whole;
        const bool is_padded = count != whole;
        float buffer[4 * copy_size];  // a part that is padded is a copy
        if (strq != nullptr) part.strq = is_padded ? buffer : strq + 4 * first;
        for (std::size_t k = 0; k < 4; ++k)
            if (out[k] != nullptr) part.out[k] = is_padded ? buffer + k * copy_size : out[k] + first;
        chosen<PointKernels>().generate(part);
        if (!is_padded) return;
        if (strq != nullptr) std::memcpy(strq + 4 * first, part.strq, 4 * count * sizeof(float));
        for (std::size_t k = 0; k < 4; ++k)
            if (out[k] != nullptr) std::memcpy(out[k] + first, part.out[k], count * sizeof(float));
    });
}

}  // namespace TEXGEN_BUILD
}  // namespace TEXGEN_DETAIL

namespace TEXGEN_NAMESPACE {

template <class Space>
Positions<Space> Positions<Space>::within(const Box& box) const noexcept {
    if (detail::is_word(box))
        for (std::size_t i = 0; i < count_; ++i) TEXGEN_ASSERT(detail::is_inside(box, (*this)[i]));
    Positions result = *this;
    result.bounds_ = box;
    return result;
}

template <class Space>
glm::dvec4 generate_error_bound(const Transform<Texture, Space>& texture_from_space,
                                Positions<Space> positions) noexcept {
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
glm::dvec2 project_error_bound(const Transform<Texture, Space>& texture_from_space, Positions<Space> positions,
                               Tolerance tolerance) noexcept {
    const glm::dmat4& matrix = texture_from_space.matrix();
    const detail::PointForm q_form = detail::form(matrix, 3);
    glm::dvec2 largest(0.0);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const glm::dvec3 v = detail::widened(positions[i]);
        const detail::Bounded q = detail::accurately_at(q_form, v);
        if (!(q.error < 0x1p1000)) return glm::dvec2(detail::infinity);
        if (q.value <= 0.0) continue;
        for (glm::length_t k = 0; k < 2; ++k) {
            const detail::PointForm form = detail::form(matrix, k);
            const detail::Bounded s = detail::accurately_at(form, v);
            const double quotient = (std::fabs(s.value) + s.error) / (q.value - q.error) * (1.0 + detail::gamma(4));
            const double of_nearest = detail::half_ulp(quotient);
            // Of the three ways to divide, the one in float errs most.
            const double of_float = detail::all_float.error(detail::terms_at(form, v), detail::terms_at(q_form, v),
                                                            std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z) + 1.0,
                                                            q.value - q.error, quotient);
            const double bound = detail::larger(detail::smaller(of_float, detail::accepted(tolerance)), of_nearest);
            largest[k] = detail::larger_or_nan(largest[k], bound);
        }
    }
    return largest;
}

inline namespace TEXGEN_BUILD {

template <class Space>
void generate(const Transform<Texture, Space>& texture_from_space, Positions<Space> positions,
              std::span<glm::vec4> strq) noexcept {
    TEXGEN_ASSERT(strq.size() == positions.size());
    if (strq.empty() || strq.size() != positions.size()) return;
    detail::generate_all(texture_from_space.matrix(), positions, {}, &strq[0].x);
}

template <class Space>
void generate(const Transform<Texture, Space>& texture_from_space, Positions<Space> positions,
              HomogeneousTexcoords out) noexcept {
    const auto array = [&](const std::span<float>& output) { return detail::array_of(output, positions.size()); };
    detail::generate_all(texture_from_space.matrix(), positions,
                         {array(out.s), array(out.t), array(out.r), array(out.q)}, nullptr);
}

template <class Space>
void project(const Transform<Texture, Space>& texture_from_space, Positions<Space> positions, TextureRegion region,
             Texcoords out, Tolerance tolerance) noexcept {
    const glm::dmat4& matrix = texture_from_space.matrix();
    const detail::LitTest lit(region);
    detail::for_each_group(out, positions.size(), lit,
                           [&](int row, int numerators, const detail::PointOutputs& outputs) {
                               detail::PointJob job = detail::point_job(matrix, row, numerators, lit, tolerance);
                               detail::project_all(positions, job, outputs);
                           });
}

template <class Space>
void project(const Transform<Texture, Space>& texture_from_space, Positions<Space> positions, std::span<glm::vec2> st,
             Tolerance tolerance) noexcept {
    TEXGEN_ASSERT(st.size() == positions.size());
    if (st.empty() || st.size() != positions.size()) return;
    const detail::LitTest unused(whole_texture());
    detail::PointJob job = detail::point_job(texture_from_space.matrix(), 0, 2, unused, tolerance);
    detail::project_all(positions, job, {{}, nullptr, &st[0].x});
}

template <class Space>
std::optional<glm::vec2> project(const Transform<Texture, Space>& texture_from_space,
                                 Position<Space> position) noexcept {
    return detail::project_point(texture_from_space.matrix(), detail::widened(position.point));
}

}  // namespace TEXGEN_BUILD
}  // namespace TEXGEN_NAMESPACE
