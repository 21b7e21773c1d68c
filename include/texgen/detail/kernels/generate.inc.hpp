// Homogeneous coordinates of points: the forms themselves, in double, rounded once. Included by kernels.inc.hpp.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

template <class CompiledWhereCalled = void>
void generate_points(const GenerateJob& original) noexcept {
    const GenerateJob job = original;
    const PointFormLanes form[4] = {job.form[0], job.form[1], job.form[2], job.form[3]};
    const std::size_t last = job.count - at_once;
    for (std::size_t i = 0;; i += at_once) {
        // What a last vector lacks is done twice: outputs overlap no positions.
        if (i > last) i = last;
        const PointLanes point = load_points(job, i);
        Floats value[4];
        TEXGEN_FOR (std::size_t k = 0; k < 4; ++k) value[k] = to_floats(value_at(form[k], point));
        if (job.strq != nullptr) {
            store_interleaved(job.strq + 4 * i, value[0], value[1], value[2], value[3]);
        } else {
            TEXGEN_FOR (std::size_t k = 0; k < 4; ++k)
                if (job.out[k] != nullptr) store(job.out[k] + i, value[k]);
        }
        if (i == last) return;
    }
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
