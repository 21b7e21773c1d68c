// Boxes against linear forms. Included by lanes.hpp once per instruction set. A form is largest over a box at the vertex
// that the signs of its coefficients pick, and least at the opposite one: one choice for all the boxes of a call.

namespace TEXGEN_DETAIL::TEXGEN_ISA {

// Where the largest value of a form is negative, the box is outside; where the least of all are positive, inside. An
// infinity makes the error one, and nothing is certain. Where min <= max, the larger magnitude is that of -min or max.
template <class = void>
void classify(const FloatForms& original, const float* boxes, std::size_t count, int* classes) noexcept {
    const FloatForms forms = original;
    for (std::size_t i = 0; i < count; i += static_cast<std::size_t>(wide_lanes)) {
        WideFloats min[3];
        WideFloats max[3];
        load_boxes(boxes + 6 * i, min, max);
        WideFloats least_of_largest = WideFloats{} + 0x1p126f;
        WideFloats least = least_of_largest;
        for (const FloatForms::Form& form : forms.form) {
            const auto at = [&form](const WideFloats& x, const WideFloats& y, const WideFloats& z) {
                return x * form.a[0] + (y * form.a[1] + (z * form.a[2] + form.d));
            };
            const bool x_grows = form.a[0] > 0.0f;
            const bool y_grows = form.a[1] > 0.0f;
            const bool z_grows = form.a[2] > 0.0f;
            const WideFloats largest = at((x_grows ? max : min)[0], (y_grows ? max : min)[1], (z_grows ? max : min)[2]);
            const WideFloats smallest =
                at((x_grows ? min : max)[0], (y_grows ? min : max)[1], (z_grows ? min : max)[2]);
            least_of_largest = minimum(largest, least_of_largest);
            least = minimum(smallest, least);
        }
        const WideFloats zero{};
        WideFloats size = zero;
        for (int j = 0; j < 3; ++j) size = size + maximum(zero - min[j], max[j]);
        const WideFloats error = size * forms.error_per_size + forms.error;
        const WideWords proper = at_most(min[0], max[0]) & at_most(min[1], max[1]) & at_most(min[2], max[2]);
        const WideWords outside = less(least_of_largest + error, zero) & proper;
        const WideWords inside = less(error - least, zero) & proper;
        const WideWords partial = less(error - least_of_largest, zero) & less(least + error, zero) & proper;
        // The masks are 0 and -1.
        store(classes + i, (outside + outside + outside) + (partial + partial) + (inside + box_doubtful));
    }
}

// What a form does not use is skipped, whatever the box has there. A NaN (of an infinity) proves nothing.
template <class = void>
void separate(const BoundedForm* forms, std::size_t count, const BoxBlock& boxes, double* least_of_largest) noexcept {
    for (std::size_t i = 0; i < box_block; i += static_cast<std::size_t>(lanes)) {
        Doubles least = Doubles{} + 1.0;
        for (std::size_t k = 0; k < count; ++k) {
            const BoundedForm& form = forms[k];
            Doubles largest = Doubles{} + (form.d + form.error_d);
            for (std::size_t j = 0; j < 3; ++j) {
                if (!form.uses[j]) continue;
                const auto vertex = load<Doubles>((form.a[j] > 0.0 ? boxes.max : boxes.min)[j] + i);
                largest = largest + vertex * form.a[j] + load<Doubles>(boxes.size[j] + i) * form.error_a;
            }
            least = minimum(largest, least);
        }
        store(least_of_largest + i, least);
    }
}

}  // namespace TEXGEN_DETAIL::TEXGEN_ISA
