// What the exact tier gives must not depend on the compiler, its flags, the machine or the kernel: a digest of the bits
// of many results, against the one that is written here; and so of what is decided exactly, and of inverses as they are
// rounded. The inputs are integers times powers of two, so that they are the same floats everywhere, and of three kinds
// in turn: any; with a constant q and few bits, so that values stand in the
// middle of two floats; small, so that q is 0 now and then.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <vector>

#ifdef WITH_BATCHES
#include <texgen/batch.hpp>
#endif
#include <texgen/clip.hpp>
#include <texgen/coverage.hpp>
#include <texgen/fixed_function.hpp>
#include <texgen/interpolate.hpp>
#include <texgen/linear.hpp>
#include <texgen/texcoord.hpp>
#include <texgen/transform.hpp>

namespace {

// splitmix64 (Steele, Lea, Flood 2014).
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed) {}

    std::uint64_t bits() {
        std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    // In [low, high].
    int integer(int low, int high) {
        return low + static_cast<int>(bits() % static_cast<std::uint64_t>(std::int64_t{high} - low + 1));
    }
    // In [-1, 1], a multiple of 2^-20.
    float unit() { return static_cast<float>(integer(-(1 << 20), 1 << 20)) * 0x1p-20f; }
    // In (0, 1].
    float positive() { return static_cast<float>(integer(1, 1 << 20)) * 0x1p-20f; }
    // A small integer.
    float small() { return static_cast<float>(integer(-4, 4)); }

private:
    std::uint64_t state_;
};

// FNV-1a of the floats' bits, the low byte first.
class Digest {
public:
    void add(float value) {
        std::uint32_t bits;
        std::memcpy(&bits, &value, sizeof bits);
        for (int shift = 0; shift < 32; shift += 8) value_ = (value_ ^ (bits >> shift & 0xff)) * 0x100000001b3u;
    }
    std::uint64_t value() const { return value_; }

private:
    std::uint64_t value_ = 0xcbf29ce484222325u;
};

constexpr std::size_t most = 1024;

// Outputs, all 0 before: where nothing is in front of the projector none but the mask is written.
struct Outputs {
    std::size_t count;
    std::array<float, most> s{}, t{}, r{}, lit{};

    explicit Outputs(std::size_t size) : count(size) {}
    texgen::Texcoords spans() { return {{s.data(), count}, {t.data(), count}, {r.data(), count}, {lit.data(), count}}; }
    bool operator==(const Outputs&) const = default;
};

// How often each class of results came up: the digest of nothing proves nothing.
struct Classes {
    int behind = 0, dark = 0, lit = 0;
};

void add(Digest& digest, Classes& classes, const Outputs& everywhere, const Outputs& on_slide) {
    for (std::size_t i = 0; i < everywhere.count; ++i) {
        digest.add(everywhere.s[i]);
        digest.add(everywhere.t[i]);
        digest.add(everywhere.r[i]);
        digest.add(everywhere.lit[i]);
        const bool lit = on_slide.lit[i] == 1.0f;
        digest.add(on_slide.lit[i]);
        // Where nothing is lit, a whole rectangle may be left alone.
        digest.add(lit ? on_slide.s[i] : 0.0f);
        digest.add(lit ? on_slide.t[i] : 0.0f);
        ++(everywhere.lit[i] == 0.0f ? classes.behind : lit ? classes.lit : classes.dark);
    }
}

enum class Kind { any, middles, zeros };
Kind kind_of(int round) { return static_cast<Kind>(round % 3); }

const texgen::TextureRegion boundless = texgen::atlas_tile({-0x1p120, -0x1p120}, {0x1p120, 0x1p120});

bool same_in_all_layouts = true;
bool same_in_batches = true;

// A matrix of the kind, with a q that is constant for `middles`.
glm::dmat4 matrix(Random& random, Kind kind) {
    glm::dmat4 m;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            m[column][row] = kind == Kind::any                 ? random.integer(-(1 << 30), 1 << 30) * 0x1p-28
                             : kind == Kind::zeros || row != 3 ? random.integer(-16, 16) * 0x1p-2
                                                               : (column == 3 ? 1.0 : 0.0);
    return m;
}

std::uint64_t points(Classes& classes) {
    Random random(1);
    Digest digest;
    std::array<glm::vec3, most> vectors;
    std::array<float, most> x, y, z;
    std::array<float, 7 * most> strided;
    for (int round = 0; round < 12; ++round) {
        const Kind kind = kind_of(round);
        const texgen::WorldTexgen texgen(matrix(random, kind));
        const auto count = static_cast<std::size_t>(random.integer(500, static_cast<int>(most)));
        for (std::size_t i = 0; i < count; ++i) {
            const auto coordinate = [&] {
                return kind == Kind::zeros ? static_cast<float>(random.integer(-8, 8)) : random.unit() * 8.0f;
            };
            x[i] = strided[7 * i] = coordinate();
            y[i] = strided[7 * i + 1] = coordinate();
            z[i] = strided[7 * i + 2] = coordinate();
            vectors[i] = glm::vec3(x[i], y[i], z[i]);
        }
        const auto projected = [&](const texgen::Positions<texgen::World>& positions, texgen::TextureRegion region) {
            Outputs out(count);
            project(texgen, positions, region, out.spans());
            return out;
        };
        const texgen::Positions<texgen::World> layouts[] = {
            texgen::world_space(std::span<const glm::vec3>(vectors.data(), count)),
            texgen::world_space({x.data(), count}, {y.data(), count}, {z.data(), count}),
            texgen::world_space(strided.data(), count, 7 * sizeof(float))};
        const Outputs everywhere = projected(layouts[0], boundless);
        for (const auto& layout : layouts)
            same_in_all_layouts = same_in_all_layouts && projected(layout, boundless) == everywhere;
        add(digest, classes, everywhere, projected(layouts[0], texgen::whole_texture()));
        std::array<glm::vec2, most> st;
        project(texgen, layouts[0], std::span<glm::vec2>(st.data(), count));
        for (std::size_t i = 0; i < count; ++i)
            same_in_all_layouts = same_in_all_layouts && st[i].x == everywhere.s[i] && st[i].y == everywhere.t[i];
    }
    return digest.value();
}

// Forms of small integers are exact in double, so that their rounding is the only one.
std::uint64_t homogeneous_points(Classes& classes) {
    Random random(2);
    Digest digest;
    glm::dmat4 m;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) m[column][row] = random.integer(-(1 << 16), 1 << 16);
    std::array<glm::vec3, most> vectors;
    for (glm::vec3& v : vectors) {
        const float x = random.unit(), y = random.unit(), z = random.unit();
        v = glm::vec3(x, y, z);
    }
    std::array<glm::vec4, most> strq;
    generate(texgen::WorldTexgen(m), texgen::world_space(vectors), strq);
    for (const glm::vec4& v : strq) {
        for (int k = 0; k < 4; ++k) digest.add(v[k]);
        ++(v.w > 0.0f ? classes.lit : classes.behind);
    }
    return digest.value();
}

glm::vec4 strq(Random& random, Kind kind) {
    const auto coordinate = [&] { return kind == Kind::zeros ? random.small() : random.unit(); };
    const float s = coordinate(), t = coordinate(), r = coordinate(), q = coordinate();
    return glm::vec4(s, t, r, kind == Kind::middles ? 1.0f : q);
}

std::uint64_t segments(Classes& classes) {
    Random random(3);
    Digest digest;
    for (int round = 0; round < 60; ++round) {
        const Kind kind = kind_of(round);
        const glm::vec4 a = strq(random, kind), b = strq(random, kind);
        const texgen::Segment segment{a, b};
        const auto count = static_cast<std::size_t>(random.integer(1, 200));
        std::array<float, most> alpha;
        for (std::size_t i = 0; i < count; ++i)
            alpha[i] = kind == Kind::any ? static_cast<float>(random.integer(0, 1 << 24)) * 0x1p-24f
                                         : static_cast<float>(random.integer(0, 24)) * 0x1p-5f;
        alpha[0] = static_cast<float>(round % 2);
        const auto interpolated = [&](texgen::TextureRegion region) {
            Outputs out(count);
            interpolate(segment, std::span<const float>(alpha.data(), count), region, out.spans());
            return out;
        };
        add(digest, classes, interpolated(boundless), interpolated(texgen::whole_texture()));
    }
    return digest.value();
}

// Two triangles and their rectangles in one batch, and the first rectangle's fragments by ids.
struct InBatch {
    texgen::Triangle triangle[2];
    texgen::FragmentRect rect[2];
    Outputs alone[2] = {Outputs(0), Outputs(0)};
};

bool same_in_a_batch([[maybe_unused]] const InBatch& given) {
    bool is_same = true;
#ifdef WITH_BATCHES
    // Somewhere else each time.
    static std::vector<std::vector<char>> others;
    if (others.size() < 16) others.emplace_back(24);
    texgen::TriangleBatch batch(boundless);
    batch.assign(given.triangle);
    is_same = is_same && reinterpret_cast<std::uintptr_t>(texgen::detail::Inside::planes(batch)) %
                                 alignof(decltype(*texgen::detail::Inside::planes(batch))) ==
                             0;
    Outputs all(given.alone[0].count + given.alone[1].count);
    if (all.count <= most) {
        interpolate(batch, given.rect, all.spans());
        for (std::size_t i = 0; i < all.count; ++i) {
            const std::size_t from = i < given.alone[0].count ? 0 : given.alone[0].count;
            const Outputs& alone = given.alone[from == 0 ? 0 : 1];
            is_same = is_same && all.s[i] == alone.s[i - from] && all.t[i] == alone.t[i - from] &&
                      all.r[i] == alone.r[i - from] && all.lit[i] == alone.lit[i - from];
        }
    }
    const texgen::FragmentRect& rect = given.rect[0];
    Outputs second(given.alone[0].count), by_id(second.count);
    if (const auto setup = texgen::TriangleSetup::of(given.triangle[1], boundless))
        interpolate(*setup, rect, second.spans());
    std::array<std::uint32_t, most> ids;
    for (std::size_t i = 0; i < second.count; ++i) ids[i] = i % 7 < 3 ? 1 : 0;
    interpolate(batch, std::span<const std::uint32_t>(ids.data(), by_id.count), rect, by_id.spans());
    for (std::size_t i = 0; i < by_id.count; ++i) {
        const Outputs& alone = ids[i] == 0 ? given.alone[0] : second;
        is_same = is_same && by_id.s[i] == alone.s[i] && by_id.t[i] == alone.t[i] && by_id.r[i] == alone.r[i] &&
                  by_id.lit[i] == alone.lit[i];
    }
#endif
    return is_same;
}

std::uint64_t triangles(Classes& classes) {
    Random random(4);
    Digest digest;
    InBatch last{};
    for (int round = 0; round < 150; ++round) {
        const Kind kind = kind_of(round);
        const auto vertex = [&](int x, int y) {
            texgen::WindowVertex corner;
            const float w = 1.0f + 3.0f * random.positive();
            corner.window = glm::vec2(static_cast<float>(x) * 0x1p-4f, static_cast<float>(y) * 0x1p-4f);
            corner.clip_w = kind == Kind::any ? w : 1.0f;
            corner.strq = strq(random, kind);
            return corner;
        };
        // Where the other two kinds need them, sides whose area is a power of two.
        const auto anywhere = [&](int otherwise) {
            const int window = random.integer(-(1 << 12), 1 << 12);
            return kind == Kind::any ? window : otherwise;
        };
        const int ax = anywhere(0), ay = anywhere(0), bx = anywhere(1 << 11), by = anywhere(0);
        const int cx = anywhere(0), cy = anywhere(1 << 11);
        const texgen::WindowVertex a = vertex(ax, ay), b = vertex(bx, by), c = vertex(cx, cy);
        const texgen::Triangle triangle{a, b, c};
        const int width = random.integer(1, 120), height = random.integer(1, 8);
        const int x = random.integer(-100, 50), y = random.integer(-100, 50);
        const texgen::FragmentRect rect{x, y, width, height};
        const auto interpolated = [&](texgen::TextureRegion region) {
            Outputs out(static_cast<std::size_t>(width * height));
            if (const auto setup = texgen::TriangleSetup::of(triangle, region)) interpolate(*setup, rect, out.spans());
            return out;
        };
        const Outputs everywhere = interpolated(boundless);
        add(digest, classes, everywhere, interpolated(texgen::whole_texture()));
        InBatch given{{triangle, last.triangle[0]}, {rect, last.rect[0]}, {everywhere, last.alone[0]}};
        same_in_batches = same_in_batches && same_in_a_batch(given);
        last = given;
    }
    return digest.value();
}

// Polygons cut at the camera's near plane, then at the slide, and put into the window.
std::uint64_t polygons(Classes& classes) {
    Random random(5);
    Digest digest;
    for (int round = 0; round < 900; ++round) {
        const Kind kind = kind_of(round);
        std::array<texgen::ClipVertex, 12> polygon, storage;
        const auto corners = static_cast<std::size_t>(random.integer(3, 4));
        for (std::size_t i = 0; i < corners; ++i) {
            const float x = random.unit(), y = random.unit(), z = random.unit();
            const float w = kind == Kind::zeros ? random.small() : 0.5f + random.unit();
            const glm::vec4 coordinates = strq(random, kind);
            polygon[i] = {glm::vec4(x, y, kind == Kind::zeros ? random.small() : z, w),
                          glm::vec4(coordinates.x + 0.5f, coordinates.y + 0.5f, coordinates.z, coordinates.w + 0.5f)};
        }
        const auto range = round % 2 == 0 ? texgen::DepthRange::zero_to_one : texgen::DepthRange::negative_one_to_one;
        const auto add_all = [&](std::size_t count) {
            digest.add(static_cast<float>(count));
            for (std::size_t i = 0; i < count; ++i)
                for (int k = 0; k < 4; ++k) digest.add(storage[i].position[k]), digest.add(storage[i].strq[k]);
        };
        const std::span<const texgen::ClipVertex> given(polygon.data(), corners);
        add_all(clip_to_slide(given, texgen::whole_texture(), storage));
        const std::size_t in_view = clip_to_near(given, storage, range, round % 5 == 0);
        add_all(in_view);
        for (std::size_t i = 0; i < in_view; ++i) {
            const texgen::WindowVertex vertex = to_window(storage[i], {3, 5, 1001, -701});
            digest.add(vertex.window.x);
            digest.add(vertex.window.y);
        }
        const std::size_t on_slide = clip_to_slide({storage.data(), in_view}, texgen::whole_texture(), storage);
        add_all(on_slide);
        ++(on_slide == 0 ? classes.behind : on_slide > corners ? classes.dark : classes.lit);
    }
    return digest.value();
}

// Boxes, most of them about the border of what is lit.
std::uint64_t bodies(Classes& classes) {
    Random random(6);
    Digest digest;
    for (int round = 0; round < 60; ++round) {
        const Kind kind = kind_of(round);
        const texgen::LitVolume<texgen::World> volume(texgen::WorldTexgen(matrix(random, kind)),
                                                      texgen::atlas_tile({-2.0, -2.0}, {2.0, 2.0}));
        std::array<texgen::Box, 75> boxes;
        for (texgen::Box& box : boxes) {
            for (int k = 0; k < 3; ++k) {
                const float middle = kind == Kind::any ? random.unit() : 0.25f * random.small();
                const float size = kind == Kind::any ? 0.5f * random.positive() : 0.25f * random.small();
                box.min[k] = middle - size;
                box.max[k] = middle + size;
            }
        }
        std::array<texgen::Coverage, 75> found;
        volume.coverage(boxes, found);
        for (const texgen::Coverage coverage : found) {
            digest.add(static_cast<float>(static_cast<int>(coverage)));
            ++(coverage == texgen::Coverage::outside   ? classes.behind
               : coverage == texgen::Coverage::partial ? classes.dark
                                                       : classes.lit);
        }
    }
    return digest.value();
}

// Inverses and stored eye planes as they are rounded, which two units of double hardly ever change; and which matrices
// are singular.
std::uint64_t inverses(Classes& classes) {
    Random random(7);
    Digest digest;
    for (int round = 0; round < 300; ++round) {
        const texgen::WorldTexgen planes(matrix(random, Kind::any));
        const glm::dmat4 regular = matrix(random, Kind::any);
        glm::dmat4 singular = regular;
        singular[3] = 2.0 * regular[0] - regular[1];
        for (const glm::dmat4& given : {regular, singular}) {
            const auto inverse = texgen::inverse(texgen::ModelMatrix(given));
            const auto stored = eye_planes_as_stored(planes, texgen::ViewMatrix(given));
            ++(inverse && stored ? classes.lit : classes.behind);
            digest.add(inverse && stored ? 1.0f : 0.0f);
            for (int k = 0; k < 16 && inverse && stored; ++k) {
                digest.add(inverse->rounded()[k / 4][k % 4]);
                digest.add(stored->rounded()[k / 4][k % 4]);
            }
        }
    }
    return digest.value();
}

// Whether eye planes of integers come back as they were: what is 0 among them is so to 2^-60 of the largest only where
// residuals have twice the digits.
bool are_integers_kept() {
    Random random(8);
    int singular = 0;
    for (int round = 0; round < 2000; ++round) {
        glm::dmat4 modelview;
        glm::dvec4 stored;
        for (int i = 0; i < 4; ++i) {
            stored[i] = static_cast<double>(random.small());
            for (int k = 0; k < 4; ++k) modelview[i][k] = static_cast<double>(random.small());
        }
        texgen::TexGenUnit unit;
        if (!unit.set_eye_plane(texgen::Coordinate::s, glm::vec4(stored * modelview), glm::mat4(modelview))) {
            ++singular;
            continue;
        }
        for (int i = 0; i < 4; ++i) {
            const auto value = static_cast<double>(unit.eye_plane(texgen::Coordinate::s)[i]);
            if (stored[i] != 0.0 ? value != stored[i] : value > 0x1p-58 || value < -0x1p-58) return false;
        }
    }
    return singular < 100;
}

bool holds = true;

void compare(const char* what, std::uint64_t (&digest_of)(Classes&), std::uint64_t expected) {
    Classes classes;
    const std::uint64_t digest = digest_of(classes);
    const bool same = digest == expected && classes.behind > 50 && classes.lit > 50;
    std::printf("%-20s %08lx%08lx, behind %d, dark %d, lit %d%s\n", what, static_cast<unsigned long>(digest >> 32),
                static_cast<unsigned long>(digest & 0xffffffff), classes.behind, classes.dark, classes.lit,
                same ? "" : ": not the bits of other builds");
    holds = holds && same;
}

}  // namespace

int main() {
#if defined(__x86_64__) && defined(__FMA__)
    if (!__builtin_cpu_supports("fma")) return 77;
#endif
    compare("points", points, 0xc74a43b09c6628d4);
    compare("homogeneous points", homogeneous_points, 0x6ee2268fe67029b3);
    compare("segments", segments, 0x8e812146eabb3761);
    compare("triangles", triangles, 0xe2857cdbe2c5b2e3);
    compare("polygons", polygons, 0xce0ff08cf94bc6dd);
    compare("bodies", bodies, 0x2e85bbd30985cf48);
    compare("inverses", inverses, 0xdc50a6ad49ba5418);
    const bool are_kept = are_integers_kept();
    if (!are_kept) std::puts("eye planes: integers do not come back");
    if (!same_in_all_layouts) std::puts("points: the layouts disagree");
    if (!same_in_batches) std::puts("triangles: in a batch they have other bits than alone, or no aligned memory");
    return holds && are_kept && same_in_all_layouts && same_in_batches ? 0 : 1;
}
