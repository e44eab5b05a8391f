// SPDX-License-Identifier: Zlib

// The files of vtk_file.hpp, read back byte by byte.

#include <demos/scenes/input_error.hpp>
#include <demos/swarm/vtk_file.hpp>
#include <tests/demos/vtp_reader.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace hashphase::demos {
namespace {

using Numbers = std::vector<std::int64_t>;

TEST(VtkFile, KeepsPointsAndTheirFieldsBitByBit) {
    const TemporaryFolder folder;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<VtkPoint> points = {{1, 2, 3}, {-0.1F, 1e30F, 5}, {0, 0, -7}};
    const std::vector<float> speeds = {0.25F, nan, -1e-40F};
    const std::vector<std::uint32_t> ranks = {7, 0, 4294967295U};
    const std::vector<std::uint64_t> ids = {1, 9007199254740993U, 18446744073709551615U};
    const VtkField fields[] = {{"speed", speeds}, {"rank", ranks}, {"id", ids}};
    writeVtkPoints(folder.file("a.vtp"), points, fields);

    VtpReader file(folder.file("a.vtp"));
    EXPECT_EQ(file.count("NumberOfPoints"), 3U);
    EXPECT_EQ(file.count("NumberOfVerts"), 3U);
    EXPECT_EQ(file.array<float>("Points", "Points", "Float32", "3"),
              std::vector<float>({1, 2, 3, -0.1F, 1e30F, 5, 0, 0, -7}));
    EXPECT_EQ(file.array<std::int64_t>("Verts", "connectivity", "Int64"), Numbers({0, 1, 2}));
    EXPECT_EQ(file.array<std::int64_t>("Verts", "offsets", "Int64"), Numbers({1, 2, 3}));
    const auto read = file.array<float>("PointData", "speed", "Float32");
    ASSERT_EQ(read.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(std::bit_cast<std::uint32_t>(read[i]), std::bit_cast<std::uint32_t>(speeds[i]));
    }
    EXPECT_EQ(file.array<std::uint32_t>("PointData", "rank", "UInt32"), ranks);
    EXPECT_EQ(file.array<std::uint64_t>("PointData", "id", "UInt64"), ids);
    EXPECT_EQ(file.bytesRead(), file.bytesThere());
}

// The writer copies in groups of 256.
TEST(VtkFile, KeepsTheOrderOfManyPoints) {
    const TemporaryFolder folder;
    for (const std::size_t count : {255U, 256U, 257U, 1000U}) {
        std::vector<VtkPoint> points;
        std::vector<float> coordinates;
        std::vector<std::uint32_t> ids;
        for (std::size_t i = 0; i < count; ++i) {
            const auto x = static_cast<float>(i);
            points.push_back({x, x + 0.25F, -x});
            coordinates.insert(coordinates.end(), {x, x + 0.25F, -x});
            ids.push_back(static_cast<std::uint32_t>(3 * i));
        }
        const VtkField fields[] = {{"id", ids}};
        writeVtkPoints(folder.file("a.vtp"), points, fields);

        VtpReader file(folder.file("a.vtp"));
        EXPECT_EQ(file.count("NumberOfPoints"), count);
        EXPECT_EQ(file.array<float>("Points", "Points", "Float32", "3"), coordinates);
        EXPECT_EQ(file.array<std::uint32_t>("PointData", "id", "UInt32"), ids);
        EXPECT_EQ(file.array<std::int64_t>("Verts", "connectivity", "Int64").back(),
                  static_cast<std::int64_t>(count) - 1);
        EXPECT_EQ(file.array<std::int64_t>("Verts", "offsets", "Int64").back(),
                  static_cast<std::int64_t>(count));
        EXPECT_EQ(file.bytesRead(), file.bytesThere());
    }
}

TEST(VtkFile, HoldsNoPointsAndNoBoxesToo) {
    const TemporaryFolder folder;
    const VtkField fields[] = {{"id", std::span<const std::uint64_t>()}};
    writeVtkPoints(folder.file("points.vtp"), {}, fields);
    writeVtkBoxes(folder.file("boxes.vtp"), {}, fields);
    for (const auto& [name, data, cells] :
         {std::array{"points.vtp", "PointData", "Verts"}, {"boxes.vtp", "CellData", "Polys"}}) {
        VtpReader file(folder.file(name));
        EXPECT_EQ(file.count("NumberOfPoints"), 0U);
        EXPECT_EQ(file.count(std::string("NumberOf") + cells), 0U);
        EXPECT_TRUE(file.array<std::uint64_t>(data, "id", "UInt64").empty());
        EXPECT_TRUE(file.array<float>("Points", "Points", "Float32", "3").empty());
        EXPECT_TRUE(file.array<std::int64_t>(cells, "connectivity", "Int64").empty());
        EXPECT_TRUE(file.array<std::int64_t>(cells, "offsets", "Int64").empty());
        EXPECT_EQ(file.bytesThere(), 4 * sizeof(std::uint64_t)) << "four lengths";
    }
}

/// Expects the quad to be the side of the box on the axis, low (0) or high (1), seen from outside.
void expectSide(const std::array<VtkPoint, 4>& quad, const VtkBox& box, std::size_t axis,
                bool isHigh) {
    const std::size_t next = (axis + 1) % 3;
    const std::size_t last = (axis + 2) % 3;
    float twiceTheArea = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const VtkPoint& a = quad[i];
        const VtkPoint& b = quad[(i + 1) % 4];
        EXPECT_EQ(a[axis], isHigh ? box.max[axis] : box.min[axis]);
        twiceTheArea += a[next] * b[last] - b[next] * a[last];
    }
    const float area = (box.max[next] - box.min[next]) * (box.max[last] - box.min[last]);
    EXPECT_EQ(twiceTheArea, isHigh ? 2 * area : -2 * area) << "counterclockwise from outside";
}

TEST(VtkFile, DrawsABoxAsSixQuadsThatFaceOutwards) {
    const TemporaryFolder folder;
    const std::vector<VtkBox> boxes = {{{0, 0, 0}, {1, 2, 4}}, {{-3, 5, 7}, {-1, 6, 15}}};
    const std::vector<std::uint32_t> ranks = {3, 8};
    const std::vector<float> loads = {0.5F, 2};
    const VtkField fields[] = {{"rank", ranks}, {"load", loads}};
    writeVtkBoxes(folder.file("boxes.vtp"), boxes, fields);

    VtpReader file(folder.file("boxes.vtp"));
    EXPECT_EQ(file.count("NumberOfPoints"), 16U);
    EXPECT_EQ(file.count("NumberOfPolys"), 12U);
    const auto corners = file.array<float>("Points", "Points", "Float32", "3");
    const auto connectivity = file.array<std::int64_t>("Polys", "connectivity", "Int64");
    ASSERT_EQ(corners.size(), 48U);
    ASSERT_EQ(connectivity.size(), 48U);
    EXPECT_EQ(file.array<std::int64_t>("Polys", "offsets", "Int64"),
              Numbers({4, 8, 12, 16, 20, 24, 28, 32, 36, 40, 44, 48}));
    for (std::size_t quad = 0; quad < 12; ++quad) {
        std::array<VtkPoint, 4> points;
        for (std::size_t i = 0; i < 4; ++i) {
            const auto point = static_cast<std::size_t>(connectivity[4 * quad + i]);
            ASSERT_EQ(point / 8, quad / 6) << "a quad has points of its own box";
            std::copy_n(&corners[3 * point], 3, points[i].begin());
        }
        expectSide(points, boxes[quad / 6], quad % 6 / 2, quad % 2 == 1);
    }
    EXPECT_EQ(file.array<std::uint32_t>("CellData", "rank", "UInt32"),
              std::vector<std::uint32_t>({3, 3, 3, 3, 3, 3, 8, 8, 8, 8, 8, 8}));
    EXPECT_EQ(file.array<float>("CellData", "load", "Float32"),
              std::vector<float>({0.5F, 0.5F, 0.5F, 0.5F, 0.5F, 0.5F, 2, 2, 2, 2, 2, 2}));
    EXPECT_EQ(file.bytesRead(), file.bytesThere());
}

TEST(VtkFile, JoinsPiecesWithTheTypesOfTheirFields) {
    const TemporaryFolder folder;
    const VtkField fields[] = {{"speed", std::span<const float>()},
                               {"rank", std::span<const std::uint32_t>()},
                               {"id", std::span<const std::uint64_t>()}};
    const std::vector<std::string> pieces = {"a_0.vtp", "parts/a & b_1.vtp"};
    for (const auto& [kind, section] : {std::pair{VtkPieceKind::points, "PPointData>"},
                                        std::pair{VtkPieceKind::boxes, "PCellData>"}}) {
        writeVtkPieces(folder.file("a.pvtp"), kind, pieces, fields);
        EXPECT_EQ(contentOf(folder.file("a.pvtp")),
                  openingOf("PPolyData") + "<PPolyData GhostLevel=\"0\">\n<" + section + "\n" +
                      "<PDataArray type=\"Float32\" Name=\"speed\"/>\n"
                      "<PDataArray type=\"UInt32\" Name=\"rank\"/>\n"
                      "<PDataArray type=\"UInt64\" Name=\"id\"/>\n</" +
                      section +
                      "\n<PPoints>\n<PDataArray type=\"Float32\" Name=\"Points\" "
                      "NumberOfComponents=\"3\"/>\n</PPoints>\n"
                      "<Piece Source=\"a_0.vtp\"/>\n<Piece Source=\"parts/a &amp; b_1.vtp\"/>\n"
                      "</PPolyData>\n</VTKFile>\n");
    }
}

TEST(VtkFile, ListsTheFilesOfSteps) {
    const TemporaryFolder folder;
    const std::vector<VtkSeriesEntry> entries = {
        {0, "a_0.pvtp"}, {0, "zones.vtp"}, {18446744073709551615U, "\"last\".vtp"}};
    writeVtkSeries(folder.file("a.pvd"), entries);
    EXPECT_EQ(contentOf(folder.file("a.pvd")),
              openingOf("Collection") +
                  "<Collection>\n<DataSet timestep=\"0\" file=\"a_0.pvtp\"/>\n"
                  "<DataSet timestep=\"0\" file=\"zones.vtp\"/>\n"
                  "<DataSet timestep=\"18446744073709551615\" file=\"&quot;last&quot;.vtp\"/>\n"
                  "</Collection>\n</VTKFile>\n");
    writeVtkSeries(folder.file("a.pvd"), {});
    EXPECT_EQ(contentOf(folder.file("a.pvd")),
              openingOf("Collection") + "<Collection>\n</Collection>\n</VTKFile>\n");
}

TEST(VtkFile, EscapesNamesAndRefusesControlCharacters) {
    const TemporaryFolder folder;
    const std::vector<float> loads = {4};
    const VtkField fields[] = {{"a<b> & \"c\" 'd' \xc3\xa9", loads}};
    const std::vector<VtkPoint> points = {{1, 2, 3}};
    writeVtkPoints(folder.file("a.vtp"), points, fields);
    EXPECT_EQ(
        VtpReader(folder.file("a.vtp"))
            .array<float>("PointData", "a&lt;b&gt; &amp; &quot;c&quot; 'd' \xc3\xa9", "Float32"),
        loads);

    const std::string control = "a\nb";
    const VtkField refused[] = {{control, loads}};
    EXPECT_THROW(writeVtkPoints(folder.file("b.vtp"), points, refused), InputError);
    EXPECT_THROW(writeVtkPieces(folder.file("b.vtp"), VtkPieceKind::points, {&control, 1}, {}),
                 InputError);
    EXPECT_FALSE(std::filesystem::exists(folder.file("b.vtp")));
}

TEST(VtkFile, RefusesAFieldOfAnotherLengthAndLeavesTheFileAlone) {
    const TemporaryFolder folder;
    const std::string path = folder.write("a.vtp", "as it was");
    const std::vector<float> loads = {1, 2};
    const VtkField fields[] = {{"load", loads}};
    const std::string fault = "The field 'load' has 2 numbers instead of 1.";
    const std::vector<VtkPoint> points(1);
    const std::vector<VtkBox> boxes(1);
    EXPECT_EQ(messageOf<std::invalid_argument>([&] { writeVtkPoints(path, points, fields); }),
              fault);
    EXPECT_EQ(messageOf<std::invalid_argument>([&] { writeVtkBoxes(path, boxes, fields); }), fault);
    EXPECT_EQ(contentOf(path), "as it was");
}

/// What each of the writers says of a path that it cannot write.
std::vector<std::string> faultsOf(const std::string& path) {
    const std::vector<VtkPoint> points(3);
    const std::vector<VtkBox> boxes(3);
    return {messageOf<InputError>([&] { writeVtkPoints(path, points, {}); }),
            messageOf<InputError>([&] { writeVtkBoxes(path, boxes, {}); }),
            messageOf<InputError>([&] { writeVtkPieces(path, VtkPieceKind::points, {}, {}); }),
            messageOf<InputError>([&] { writeVtkSeries(path, {}); })};
}

TEST(VtkFile, NamesAPathThatCannotBeWritten) {
    const TemporaryFolder folder;
    const std::string missing = folder.file("missing/a.vtp");
    const std::string itself = folder.path().string();
    EXPECT_EQ(faultsOf(missing),
              std::vector(4, missing + " cannot be written: No such file or directory."));
    EXPECT_EQ(faultsOf(itself), std::vector(4, itself + " is a folder, not a file."));
    EXPECT_EQ(faultsOf(""), std::vector<std::string>(4, "A file for ParaView needs a name."));
    if (std::filesystem::exists("/dev/full")) {
        EXPECT_EQ(faultsOf("/dev/full"),
                  std::vector<std::string>(
                      4, "/dev/full cannot be written to its end; is the disk full?"));
    }
}

}  // namespace
}  // namespace hashphase::demos
