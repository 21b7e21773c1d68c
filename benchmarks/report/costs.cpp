#include "costs.hpp"

#include <algorithm>

#include "failure.hpp"
#include "files.hpp"
#include "html.hpp"

namespace report {

namespace {

// An empty field is 0.
double cost_of(const std::string& field, const std::string& file) {
    const std::optional<double> value = field.empty() ? 0.0 : number_of(field);
    if (!value) throw Failure{"no costs in " + file};
    return *value;
}

// A row of the table, as text: the seconds, those that a call adds to its header or a header's as a multiple of GLM's,
// and the kilobytes that are added.
struct Row {
    bool is_call;
    std::string name, seconds, added, object, code;
};

std::vector<Row> rows_of(const std::vector<Cost>& costs) {
    std::vector<Row> rows;
    for (const Cost& cost : costs) {
        const bool is_call = !cost.header.empty();
        const auto header =
            std::ranges::find_if(costs, [&](const Cost& other) { return is_call && other.name == cost.header; });
        const double of_header = header != costs.end() ? header->milliseconds : 0;
        const double nothing = header != costs.end() ? header->object_bytes : costs.front().object_bytes;
        rows.push_back({is_call, cost.name, formatted("%.2f", cost.milliseconds / 1e3),
                        is_call ? formatted("+%.2f s", std::max(cost.milliseconds - of_header, 0.0) / 1e3)
                                : formatted("%.2fx GLM", cost.milliseconds / costs.front().milliseconds),
                        formatted("%.1f", std::max(cost.object_bytes - nothing, 0.0) / 1e3),
                        formatted("%.1f", cost.code_bytes / 1e3)});
    }
    return rows;
}

}  // namespace

std::vector<Cost> read_costs(const std::string& file) {
    std::vector<Cost> costs;
    for (const std::vector<std::string>& fields : read_fields(file)) {
        if (fields.size() != 5 || fields[0].empty() || fields[2].empty()) throw Failure{"no costs in " + file};
        costs.push_back(
            {fields[0], fields[1], cost_of(fields[2], file), cost_of(fields[3], file), cost_of(fields[4], file)});
        if (!(costs.back().milliseconds > 0)) throw Failure{"no costs in " + file};
    }
    return costs;
}

std::string text_of(const std::vector<Cost>& costs) {
    if (costs.empty()) return {};
    std::string text = formatted("%-30s %12s %12s %12s %12s\n", "a file that includes or calls", "seconds", "added",
                                 "object kB", "code kB");
    for (const Row& row : rows_of(costs))
        text += formatted("%-30s %12s %12s %12s %12s\n", row.name.c_str(), row.seconds.c_str(), row.added.c_str(),
                          row.object.c_str(), row.code.c_str());
    return text;
}

std::string html_of(const std::vector<Cost>& costs) {
    if (costs.empty()) return {};
    std::string html =
        "<p>A file that includes a header alone, and one that calls a function, "
        "compiled with -O2: the compiler's processor time, the least of some runs in turns; what a header costs as a "
        "multiple of GLM's matrix headers, what a call adds to the header that has it; and the bytes that the object "
        "gets, of these machine code. Kernels are in it for each instruction set that the machine may "
        "choose.</p>\n"
        "<div class=\"wide\"><table>\n<tr><th>file</th><th>seconds</th><th>added</th><th>object kB</th><th>code "
        "kB</th></tr>\n";
    for (const Row& row : rows_of(costs))
        html += std::string(row.is_call ? "<tr class=\"library\"><td>" : "<tr><td>") + escaped(row.name) + "</td><td>" +
                row.seconds + "</td><td>" + row.added + "</td><td>" + row.object + "</td><td>" + row.code +
                "</td></tr>\n";
    return html + "</table></div>\n";
}

}  // namespace report
