// The worst time of each public function over the ordinary one: of the inputs that searches have found, of those that
// searches begin with, of triangles that the near plane has cut, and of scenes from frame to frame. An input is timed
// in turns with ordinary ones; of each the least time counts.
//
//   texgen_worst [FILE]    writes lines of function|input|ordinary ns|worst ns|limit

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include <glm/ext/matrix_transform.hpp>

#include "../printed.hpp"
#include "support/near_cut.hpp"
#include "support/race.hpp"
#include "support/random.hpp"
#include "support/stopwatch.hpp"
#include "support/workloads.hpp"

namespace {

using support::Numbers;
using support::Random;
using support::Workload;

struct Row {
    std::string function, input;
    double ordinary, worst, limit;
};

// What searches found, and what they begin with

void add_rows(const Workload& workload, const std::vector<support::RecordedInput>& recorded, std::vector<Row>& rows) {
    const support::Race race(workload);
    support::Slowest slowest(workload, race);
    for (const support::RecordedInput& input : recorded)
        if (input.function == workload.function) slowest.offer(input.numbers, race.glance(input.numbers), input.words);
    Random random(11);
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(250);
    for (int i = 0; i < 400 && std::chrono::steady_clock::now() < end; ++i) {
        const Numbers numbers = workload.inputs.draw(random);
        slowest.offer(numbers, race.glance(numbers), workload.inputs.words);
    }
    for (const support::SlowInput& input : slowest.inputs())
        rows.push_back({workload.function, input.words, input.slowness.ordinary, input.slowness.hostile, input.limit});
}

// Triangles that the near plane has cut

void add_near_cuts(const Workload& workload, std::vector<Row>& rows) {
    constexpr int triangles = 240;
    const support::NearCutTimes times = support::race_near_cuts(workload, triangles);
    const auto add = [&](const std::string& input, const support::Slowness& slowness, double limit) {
        rows.push_back({workload.function, input, slowness.ordinary, slowness.hostile, limit});
    };
    add("the slowest of " + std::to_string(triangles) +
            " triangles that the near plane cut, in all orders of their corners",
        times.slowest, support::limit::near_plane);
    add("99 of 100 of those", times.of_99_in_100, support::limit::near_plane_99_of_100);
    add("the slowest order of the corners of one of those over the fastest", times.rotation, support::limit::rotation);
}

// Scenes

// Objects of about a unit on a plain, and a spotlight above it.
class Plain {
public:
    explicit Plain(std::size_t objects) : side_(std::sqrt(static_cast<double>(objects))) {
        for (std::size_t i = 0; i < objects; ++i) grow();
        const texgen::PerspectiveLens lens{texgen::degrees(30.0), 1.0, 0.1, 100.0};
        projectors_.push_back(
            texgen::make_projector(lens, {{0, 6, 0}, {1, 0, 2}, {0.1, 1, 0.2}}, texgen::opengl).value());
        update({});
    }

    void grow() {
        bounds_.push_back({glm::vec3(-0.4f), glm::vec3(0.4f)});
        models_.push_back(place());
    }
    // Of one object, to anywhere.
    void move() {
        next_ = (next_ + 7919) % models_.size();
        models_[next_] = place();
        moved_ = static_cast<std::uint32_t>(next_);
    }
    void update_moved() { update({&moved_, 1}); }
    void update(std::span<const std::uint32_t> objects) {
        scene_.update({models_, bounds_, projectors_}, {objects, {}});
    }

private:
    texgen::ModelMatrix place() {
        const glm::dvec3 to(random_.uniform(-side_, side_), 0.5, random_.uniform(-side_, side_));
        return texgen::ModelMatrix(glm::translate(glm::dmat4(1.0), to));
    }

    Random random_{7};
    double side_;
    std::size_t next_ = 0;
    std::uint32_t moved_ = 0;
    std::vector<texgen::ModelMatrix> models_;
    std::vector<texgen::Box> bounds_;
    std::vector<texgen::Projector> projectors_;
    texgen::Scene scene_;
};

// The slowest frame over the median one: each frame's least time of several scenes that go the same way.
template <class Prepare, class Update>
void add_frames(const std::string& input, std::size_t frames, Prepare prepare, Update update, std::vector<Row>& rows) {
    std::vector<double> least(frames, 1e300);
    for (int run = 0; run < 5; ++run) {
        Plain plain(10000);
        for (double& time : least) {
            prepare(plain);
            const auto begin = std::chrono::steady_clock::now();
            update(plain);
            const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - begin;
            time = std::min(time, taken.count());
        }
    }
    std::sort(least.begin(), least.end());
    rows.push_back({"Scene::update, 10 000 objects", input, least[frames / 2], least.back(), support::limit::frame});
}

void add_scenes(std::vector<Row>& rows) {
    add_frames(
        "the slowest of 20 000 frames in which an object moves anywhere, over the median one", 20000,
        [](Plain& plain) { plain.move(); }, [](Plain& plain) { plain.update_moved(); }, rows);
    add_frames(
        "the slowest of 2 000 frames that have an object more than the one before, over the median one", 2000,
        [](Plain& plain) { plain.grow(); }, [](Plain& plain) { plain.update({}); }, rows);
}

}  // namespace

int main(int count, char** arguments) {
    std::vector<Row> rows;
    std::ifstream inputs(TEXGEN_WORST_INPUTS);
    const std::vector<support::RecordedInput> recorded = support::read_inputs(inputs);
    for (const Workload& workload : support::workloads) add_rows(workload, recorded, rows);
    for (const Workload& workload : support::workloads)
        if (workload.takes_near_cuts()) add_near_cuts(workload, rows);
    add_scenes(rows);

    std::ostringstream lines;
    for (const Row& row : rows) {
        char figures[128];
        std::snprintf(figures, sizeof figures, "|%.6g|%.6g|%g\n", row.ordinary, row.worst, row.limit);
        lines << row.function << '|' << row.input << figures;
    }
    if (count < 2) {
        std::fputs(lines.str().c_str(), stdout);
        if (is_printed()) return 0;
        std::fputs("texgen_worst: cannot write to standard output\n", stderr);
        return 2;
    }
    std::ofstream file(arguments[1]);
    if (file << lines.str() << std::flush) return 0;
    std::fprintf(stderr, "texgen_worst: cannot write %s\n", arguments[1]);
    return 2;
}
