#include "worst_times.hpp"

#include <algorithm>
#include <optional>

#include "failure.hpp"
#include "files.hpp"
#include "html.hpp"

namespace report {

std::vector<WorstTime> read_worst_times(const std::string& file) {
    const Failure failure{"no worst times in " + file};
    std::vector<WorstTime> times;
    for (const std::vector<std::string>& fields : read_fields(file)) {
        if (fields.size() != 5 || fields[0].empty()) throw failure;
        const auto positive = [&](const std::string& field) {
            const std::optional<double> value = number_of(field);
            if (!value || !(*value > 0)) throw failure;
            return *value;
        };
        times.push_back({fields[0], fields[1], positive(fields[2]), positive(fields[3]), positive(fields[4])});
    }
    if (times.empty()) throw failure;
    return times;
}

std::string text_of(const std::vector<WorstTime>& times) {
    if (times.empty()) return {};
    std::string text = formatted("%-52s %12s %12s %9s %6s  %-8s %s\n", "the worst input found for", "ordinary ns",
                                 "worst ns", "ratio", "limit", "", "it is");
    for (const WorstTime& time : times)
        text += formatted("%-52s %12.1f %12.1f %9.1f %6g  %-8s ", time.function.c_str(), time.ordinary, time.worst,
                          time.ratio(), time.limit, time.is_met() ? "met" : "NOT MET") +
                time.input + "\n";
    return text;
}

std::string html_of(const std::vector<WorstTime>& times) {
    if (times.empty()) return {};
    const auto met = std::ranges::count_if(times, &WorstTime::is_met);
    std::string html =
        "<p>A call with an ordinary input, the average of some; with the "
        "worst one that a search for slow inputs has found, or of those that it begins with; and the limit of worst "
        "over ordinary. The least of several times each, taken in turns, with -O2; on a machine that interrupts itself "
        "for subnormal numbers with these as 0. " +
        formatted("%d of %d are within their limits.", static_cast<int>(met), static_cast<int>(times.size())) +
        "</p>\n<div class=\"wide\"><table>\n<tr><th>function</th><th>ordinary ns</th><th>worst "
        "ns</th><th>ratio</th><th>limit</th>"
        "<th>met</th><th>the worst input</th></tr>\n";
    for (const WorstTime& time : times)
        html += std::string(time.is_met() ? "<tr class=\"library\"><td>" : "<tr><td>") + escaped(time.function) +
                formatted("</td><td>%.1f</td><td>%.1f</td><td>%.1f</td><td>%g</td><td>%s</td><td>", time.ordinary,
                          time.worst, time.ratio(), time.limit, time.is_met() ? "yes" : "no") +
                escaped(time.input) + "</td></tr>\n";
    return html + "</table></div>\n";
}

}  // namespace report
