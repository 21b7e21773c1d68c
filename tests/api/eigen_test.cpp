// Eigen's border: matrices keep every element and their spaces, arrays are seen where they are.

#include "texgen/eigen.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <array>
#include <type_traits>
#include <vector>

#include "support/hex.hpp"
#include "support/random.hpp"
#include "texgen/linear.hpp"

namespace {

using support::hex;
using support::Random;
using RowMajor3X = Eigen::Matrix<float, 3, Eigen::Dynamic, Eigen::RowMajor>;
using RowMajorX3 = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;
using Gaps = Eigen::Stride<Eigen::Dynamic, Eigen::Dynamic>;

// What compiles: seen from a template, so that the answer is no is not an error.
template <class Points>
concept ArePoints = requires(Points&& points) {
    texgen::world_space(static_cast<Points&&>(points));
};
template <class Coordinates>
concept AreCoordinates = requires(Coordinates&& c) {
    texgen::world_space(c, c, c);
};
template <class Coordinates>
concept AreTemporaryCoordinates = requires(Coordinates&& c) {
    texgen::world_space(std::move(c), std::move(c), std::move(c));
};
template <class Values>
concept AreFloats = requires(Values&& values) {
    texgen::floats(static_cast<Values&&>(values));
};
template <class Matrix>
concept IsTransform = requires(const Matrix& matrix) {
    texgen::from_eigen<texgen::ModelMatrix>(matrix);
};

template <class T>
concept HasData = requires(const T& t) {
    t.data();
};
template <class Role>
concept IsRole = requires(const Eigen::Matrix4d& matrix) {
    texgen::from_eigen<Role>(matrix);
};

// As Eigen's manual has it, under "Inheriting from Matrix".
struct Cloud : Eigen::Matrix3Xf {
    using Eigen::Matrix3Xf::Matrix3Xf;
};

// q takes either sign.
texgen::WorldTexgen random_texgen(Random& random) { return texgen::WorldTexgen(random.matrix(10.0)); }

std::vector<glm::vec3> random_points(Random& random, std::size_t count) {
    std::vector<glm::vec3> points(count);
    for (glm::vec3& point : points) point = random.vector3(10.0);
    return points;
}

struct Outputs {
    std::vector<float> s, t, r, lit;

    explicit Outputs(std::size_t count) : s(count), t(count), r(count), lit(count) {}
    texgen::Texcoords spans() { return {s, t, r, lit}; }
    friend bool operator==(const Outputs&, const Outputs&) = default;
};

Outputs projected(const texgen::WorldTexgen& texgen, const texgen::Positions<texgen::World>& positions) {
    Outputs out(positions.size());
    project(texgen, positions, texgen::whole_texture(), out.spans());
    return out;
}

// The positions are the points, read at `first` and not from a copy, and project to the same bits.
void check_same(const std::vector<glm::vec3>& points, const texgen::Positions<texgen::World>& positions,
                const float* first) {
    REQUIRE(positions.size() == points.size());
    if (!points.empty()) CHECK(positions.x() == first);
    for (std::size_t i = 0; i < points.size(); ++i) REQUIRE_MESSAGE(positions[i] == points[i], hex(points[i]));
    Random random(63);
    const auto texgen = random_texgen(random);
    REQUIRE(projected(texgen, positions) == projected(texgen, texgen::world_space(points)));
}

constexpr std::size_t counts[] = {0, 1, 2, 15, 16, 17, 64, 300};

}  // namespace

TEST_CASE("a transform comes from Eigen with every element, and knows its spaces") {
    Random random(61);
    for (int i = 0; i < 200; ++i) {
        const glm::dmat4 m = random.matrix(10.0);
        Eigen::Matrix4d eigen;
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row) eigen(row, column) = m[column][row];
        const auto view = texgen::from_eigen<texgen::ViewMatrix>(eigen);
        static_assert(std::is_same_v<decltype(view), const texgen::ViewMatrix>);
        REQUIRE_MESSAGE(view.matrix() == m, hex(m));
        const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> row_major = eigen;
        REQUIRE(texgen::from_eigen<texgen::ViewMatrix>(row_major).matrix() == m);
        REQUIRE(texgen::from_eigen<texgen::ViewMatrix>(Eigen::Projective3d(eigen)).matrix() == m);
        REQUIRE(texgen::from_eigen<texgen::ViewMatrix>(eigen.transpose()).matrix() == glm::transpose(m));
        // Eigen keeps a last row that such a transform does not have.
        REQUIRE(texgen::from_eigen<texgen::ViewMatrix>(Eigen::Affine3d(eigen)).matrix() == m);
        Eigen::Isometry3d isometry;
        isometry.matrix() = eigen;
        REQUIRE(texgen::from_eigen<texgen::ViewMatrix>(isometry).matrix() == m);
        static_assert(noexcept(texgen::from_eigen<texgen::ViewMatrix>(eigen)));

        const glm::mat4 floats = support::rounded(m);
        Eigen::Matrix4f eigen_floats;
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row) eigen_floats(row, column) = floats[column][row];
        REQUIRE(texgen::from_eigen<texgen::ViewMatrix>(eigen_floats).rounded() == floats);
        REQUIRE(texgen::from_eigen<texgen::ViewMatrix>(eigen_floats).matrix() == texgen::ViewMatrix(floats).matrix());
    }
}

TEST_CASE("poses come from every mode of Eigen's transforms, the compact one too") {
    const Eigen::Isometry3d pose =
        Eigen::Translation3d(1.0, 2.0, 3.0) * Eigen::AngleAxisd(0.5, Eigen::Vector3d(1.0, 2.0, -2.0).normalized());
    const Eigen::Matrix4d m = pose.matrix();
    CHECK(to_eigen(texgen::from_eigen<texgen::CameraPose>(pose)) == m);
    CHECK(to_eigen(texgen::from_eigen<texgen::CameraPose>(Eigen::Affine3d(pose))) == m);
    CHECK(to_eigen(texgen::from_eigen<texgen::CameraPose>(Eigen::AffineCompact3d(pose))) == m);
    const Eigen::Affine3f single = Eigen::Affine3d(pose).cast<float>();
    CHECK(texgen::to_eigen<Eigen::Matrix4f>(texgen::from_eigen<texgen::CameraPose>(single)) == single.matrix());
}

TEST_CASE("a transform goes to Eigen exactly in double and rounded once in float") {
    Random random(62);
    for (int i = 0; i < 200; ++i) {
        const texgen::ModelMatrix model(random.matrix(10.0));
        REQUIRE(texgen::from_eigen<texgen::ModelMatrix>(to_eigen(model)).matrix() == model.matrix());
        REQUIRE(texgen::to_eigen<Eigen::Projective3d>(model).matrix() == to_eigen(model));
        const auto rounded = texgen::to_eigen<Eigen::Matrix4f>(model);
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row)
                REQUIRE(rounded(row, column) == support::to_float(model.matrix()[column][row]));
        REQUIRE_FALSE(texgen::to_eigen_affine(model));

        const texgen::ModelMatrix rigid(random.rigid(100.0));
        const auto affine = texgen::to_eigen_affine(rigid);
        REQUIRE(affine);
        REQUIRE(affine->matrix() == to_eigen(rigid));
        REQUIRE(texgen::to_eigen_affine<Eigen::Affine3f>(rigid)->matrix() == texgen::to_eigen<Eigen::Matrix4f>(rigid));
    }
    for (int column = 0; column < 4; ++column) {
        glm::dmat4 m(1.0);
        m[column][3] += 0x1p-52;
        CHECK_FALSE(texgen::to_eigen_affine(texgen::ModelMatrix(m)));
    }
}

TEST_CASE("vectors cross in both directions, element by element") {
    CHECK(texgen::to_eigen(glm::vec3(1, 2, 3)) == Eigen::Vector3f(1, 2, 3));
    CHECK(texgen::to_eigen(glm::dvec4(1, 2, 3, 0.1)) == Eigen::Vector4d(1, 2, 3, 0.1));
    CHECK(texgen::to_eigen(glm::vec2(1, 2)) == Eigen::Vector2f(1, 2));
    CHECK(texgen::to_glm(Eigen::Vector3d(1, 2, 0.1)) == glm::dvec3(1, 2, 0.1));
    const Eigen::Vector4f v(1, 2, 3, 4);
    CHECK(texgen::to_glm(v) == glm::vec4(1, 2, 3, 4));
    CHECK(texgen::to_glm(2.0f * v.head<2>()) == glm::vec2(2, 4));
    const Eigen::Matrix3d m{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
    CHECK(texgen::to_glm(m * Eigen::Vector3d::UnitY()) == glm::dvec3(2, 5, 8));
    static_assert(std::is_same_v<decltype(texgen::to_glm(v)), glm::vec4>);
}

TEST_CASE("points are seen where they are: columns, rows, blocks, references, arrays and maps with gaps") {
    Random random(64);
    for (const std::size_t count : counts) {
        CAPTURE(count);
        const std::vector<glm::vec3> points = random_points(random, count);
        const auto n = static_cast<Eigen::Index>(count);
        const auto fill = [&](auto&& columns) {
            for (Eigen::Index i = 0; i < n; ++i) columns.col(i) = texgen::to_eigen(points[static_cast<std::size_t>(i)]);
        };

        Eigen::Matrix3Xf dense(3, n);
        fill(dense);
        check_same(points, texgen::world_space(dense), dense.data());
        CHECK((count == 0 || texgen::world_space(dense).is_interleaved()));
        const Eigen::Ref<const Eigen::Matrix3Xf> reference = dense;
        check_same(points, texgen::world_space(reference), dense.data());
        const Eigen::Array3Xf array = dense;
        check_same(points, texgen::world_space(array), array.data());

        RowMajor3X planar(3, n);
        fill(planar);
        check_same(points, texgen::world_space(planar), planar.data());
        CHECK((count == 0 || texgen::world_space(planar).is_planar()));

        Eigen::MatrixX3f rows = dense.transpose();
        check_same(points, texgen::world_space(rows), rows.data());
        CHECK((count == 0 || texgen::world_space(rows).is_planar()));
        RowMajorX3 row_points = dense.transpose();
        check_same(points, texgen::world_space(row_points), row_points.data());
        CHECK((count == 0 || texgen::world_space(row_points).is_interleaved()));

        // Columns of eight floats, of which the positions are three; and the same through references.
        Eigen::Matrix<float, 8, Eigen::Dynamic> vertices(8, n);
        vertices.setConstant(-1e9f);
        fill(vertices.middleRows<3>(2));
        check_same(points, texgen::world_space(vertices.middleRows<3>(2)), vertices.data() + 2);
        const Eigen::Ref<const Eigen::Matrix3Xf> strided = vertices.middleRows<3>(2);
        check_same(points, texgen::world_space(strided), vertices.data() + 2);

        // Gaps inside a point and between points.
        std::vector<float> memory(count * 17 + 1, -1e9f);
        Eigen::Map<Eigen::Matrix3Xf, 0, Gaps> gaps(memory.data(), 3, n, Gaps(17, 5));
        fill(gaps);
        check_same(points, texgen::world_space(gaps), memory.data());
        const Eigen::Map<const RowMajorX3, 0, Gaps> row_gaps(memory.data(), n, 3, Gaps(17, 5));
        check_same(points, texgen::world_space(row_gaps), memory.data());
        check_same(points, texgen::world_space(gaps.row(0), gaps.row(1), gaps.row(2)), memory.data());

        // Three vectors: of their own, columns and rows of matrices.
        const Eigen::VectorXf x = dense.row(0), y = dense.row(1), z = dense.row(2);
        check_same(points, texgen::world_space(x, y, z), x.data());
        CHECK((count == 0 || texgen::world_space(x, y, z).is_planar()));
        check_same(points, texgen::world_space(rows.col(0), rows.col(1), rows.col(2)), rows.data());
        check_same(points, texgen::world_space(dense.row(0), dense.row(1), dense.row(2)), dense.data());
        const Eigen::ArrayXf ax = x, ay = y;
        check_same(points, texgen::world_space(ax, ay, rows.col(2)), ax.data());
    }
}

TEST_CASE("each space has its own view") {
    const Eigen::Matrix3Xf points = Eigen::Matrix3Xf::Random(3, 4);
    const Eigen::VectorXf x = points.row(0);
    static_assert(std::is_same_v<decltype(texgen::object_space(points)), texgen::Positions<texgen::Object>>);
    static_assert(std::is_same_v<decltype(texgen::world_space(points)), texgen::Positions<texgen::World>>);
    static_assert(std::is_same_v<decltype(texgen::eye_space(points)), texgen::Positions<texgen::Eye>>);
    static_assert(std::is_same_v<decltype(texgen::window_space(points)), texgen::Positions<texgen::Window>>);
    static_assert(std::is_same_v<decltype(texgen::object_space(x, x, x)), texgen::Positions<texgen::Object>>);
    static_assert(std::is_same_v<decltype(texgen::eye_space(x, x, x)), texgen::Positions<texgen::Eye>>);
    CHECK(texgen::object_space(points)[3] == texgen::to_glm(points.col(3)));
    CHECK(texgen::eye_space(points)[3] == texgen::to_glm(points.col(3)));
    CHECK(texgen::window_space(points)[3] == texgen::to_glm(points.col(3)));
    CHECK(texgen::window_space(x, x, x)[1] == glm::vec3(x[1]));
    CHECK(texgen::object_space(x, x, x)[1] == glm::vec3(x[1]));
    CHECK(texgen::eye_space(x, x, x)[1] == glm::vec3(x[1]));
    // A single point is one, standing or lying.
    const Eigen::Vector3f point(1, 2, 3);
    CHECK(texgen::world_space(point).size() == 1);
    CHECK(texgen::world_space(point)[0] == glm::vec3(1, 2, 3));
    const Eigen::RowVector3f lying(1, 2, 3);
    CHECK(texgen::world_space(lying)[0] == glm::vec3(1, 2, 3));
}

TEST_CASE("what would need a copy, or be read at a wrong place, does not compile") {
    using Expression = decltype(std::declval<Eigen::Matrix3Xf&>() + std::declval<Eigen::Matrix3Xf&>());
    using Row = decltype(std::declval<Eigen::Matrix3Xf&>().row(0));
    using Column = decltype(std::declval<Eigen::Matrix3Xf&>().col(0));
    static_assert(ArePoints<Eigen::Matrix3Xf&> && ArePoints<const Eigen::Matrix3Xf&>);
    static_assert(ArePoints<Eigen::Ref<const Eigen::Matrix3Xf>> && ArePoints<Eigen::Map<const Eigen::MatrixX3f>>);
    static_assert(!ArePoints<Eigen::Matrix3Xf>, "a temporary that owns its points");
    static_assert(ArePoints<Cloud&> && !ArePoints<Cloud> && !AreFloats<Cloud&>);
    static_assert(!ArePoints<Expression>, "an expression");
    using Indexed =
        decltype(std::declval<Eigen::Matrix3Xf&>()(Eigen::seqN(Eigen::fix<0>, Eigen::fix<3>), Eigen::seqN(0, 4, 2)));
    static_assert(!ArePoints<Indexed> || HasData<Indexed>);
    static_assert(!ArePoints<Eigen::Matrix3Xd&>, "doubles");
    static_assert(!ArePoints<Eigen::Matrix3f&>, "rows or columns?");
    static_assert(!ArePoints<Eigen::Matrix4Xf&> && !ArePoints<Eigen::MatrixXf&>, "no three coordinates");
    static_assert(ArePoints<std::vector<glm::vec3>&> && ArePoints<std::array<glm::vec3, 2>&>);
    static_assert(AreCoordinates<Eigen::VectorXf&> && AreCoordinates<Eigen::ArrayXf&> && AreCoordinates<Row>);
    static_assert(!AreCoordinates<Eigen::VectorXd&> && !AreCoordinates<Eigen::MatrixXf&>);
    static_assert(AreCoordinates<std::vector<float>&>);
    static_assert(!AreTemporaryCoordinates<Eigen::VectorXf> && !AreTemporaryCoordinates<Eigen::ArrayXf>);
    static_assert(AreTemporaryCoordinates<Row>, "views");
    static_assert(AreFloats<Eigen::VectorXf&> && AreFloats<Eigen::Ref<Eigen::ArrayXf>> && AreFloats<Column>);
    static_assert(!AreFloats<Row> && !AreFloats<Eigen::VectorXf> && !AreFloats<Eigen::VectorXd&>);
    static_assert(!AreFloats<Eigen::Map<Eigen::VectorXf, 0, Eigen::InnerStride<2>>>);
    static_assert(!AreFloats<Eigen::Ref<Eigen::VectorXf, 0, Eigen::InnerStride<>>>);
    static_assert(!AreFloats<Eigen::ArrayXXf&>, "columns of fragments");
    static_assert(IsTransform<Eigen::Matrix4d> && IsTransform<Eigen::Affine3f>);
    static_assert(!IsTransform<Eigen::Matrix3d> && !IsTransform<Eigen::Matrix4i> && !IsTransform<Eigen::Affine2d>);
    static_assert(!IsTransform<Eigen::Transform<int, 3, Eigen::Affine>>);
    static_assert(!IsTransform<Eigen::Transform<long double, 3, Eigen::Affine>>);
    static_assert(IsRole<texgen::ModelMatrix> && !IsRole<glm::mat4> && !IsRole<glm::dmat4>);
    static_assert(!std::is_convertible_v<Eigen::Matrix4d, texgen::ModelMatrix>);
}

TEST_CASE("what is seen as MatrixBase or ArrayBase is what it is of") {
    Random random(66);
    const std::vector<glm::vec3> points = random_points(random, 20);
    Cloud cloud(3, 20);
    for (Eigen::Index i = 0; i < 20; ++i) cloud.col(i) = texgen::to_eigen(points[static_cast<std::size_t>(i)]);
    check_same(points, texgen::world_space(cloud), cloud.data());
    const Eigen::MatrixBase<Eigen::Matrix3Xf>& base = cloud;
    check_same(points, texgen::world_space(base), cloud.data());
    Eigen::ArrayXf values(4);
    CHECK(texgen::floats(values.array()).data() == values.data());
}

TEST_CASE("outputs go straight into Eigen's vectors and images") {
    Random random(65);
    const auto texgen = random_texgen(random);
    const std::vector<glm::vec3> points = random_points(random, 100);
    const Outputs expected = projected(texgen, texgen::world_space(points));

    Eigen::ArrayXf s(100);
    Eigen::MatrixX2f t_and_lit(100, 2);
    Eigen::Array<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> r(4, 25);
    Eigen::Ref<Eigen::ArrayXf> s_reference = s;
    project(texgen, texgen::world_space(points), texgen::whole_texture(),
            {.s = texgen::floats(s_reference),
             .t = texgen::floats(t_and_lit.col(0)),
             .r = texgen::floats(r),
             .lit = texgen::floats(t_and_lit.col(1))});
    bool some_lit = false, some_dark = false;
    for (Eigen::Index i = 0; i < 100; ++i) {
        const auto k = static_cast<std::size_t>(i);
        REQUIRE(s(i) == expected.s[k]);
        REQUIRE(t_and_lit(i, 0) == expected.t[k]);
        REQUIRE(r(i / 25, i % 25) == expected.r[k]);
        REQUIRE(t_and_lit(i, 1) == expected.lit[k]);
        (expected.lit[k] == 1.0f ? some_lit : some_dark) = true;
    }
    CHECK(some_lit);
    CHECK(some_dark);
    const Eigen::ArrayXf& constant = s;
    static_assert(std::is_same_v<decltype(texgen::floats(constant)), std::span<const float>>);
    CHECK(texgen::floats(constant).data() == s.data());
    CHECK(texgen::floats(constant).size() == 100);
}
