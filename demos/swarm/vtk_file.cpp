// SPDX-License-Identifier: Zlib

// After "VTK XML Formats" in the documentation of VTK (Kitware). The numbers follow the XML as
// "appended raw data": each array is its length in bytes and its bytes, found by an offset.

#include <demos/swarm/vtk_file.hpp>

#include <demos/console/result_file.hpp>
#include <demos/scenes/input_error.hpp>

#include <algorithm>
#include <bit>
#include <functional>
#include <ostream>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

namespace hashphase::demos {
namespace {

// --- XML -----------------------------------------------------------------------------------------

/// The attribute with a blank in front, escaped. Throws InputError for what XML cannot hold.
std::string attribute(std::string_view name, std::string_view value) {
    constexpr std::array<std::string_view, 4> kEscapes = {"&amp;", "&lt;", "&gt;", "&quot;"};
    std::string text(1, ' ');
    text.append(name) += "=\"";
    for (const char letter : value) {
        if (static_cast<unsigned char>(letter) < ' ') {
            throw InputError("A name in a file for ParaView cannot have control characters.");
        }
        const std::size_t special = std::string_view("&<>\"").find(letter);
        text += special < kEscapes.size() ? kEscapes[special] : std::string_view(&letter, 1);
    }
    return text + '"';
}

std::string attribute(std::string_view name, std::uint64_t value) {
    return attribute(name, std::to_string(value));
}

/// The first lines of any of the files.
std::string opening(std::string_view type) {
    return "<?xml version=\"1.0\"?>\n<VTKFile" + attribute("type", type) +
           attribute("version", "1.0") +
           attribute("byte_order",
                     std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian") +
           attribute("header_type", "UInt64") + ">\n";
}

void writeFile(const std::string& path, const std::function<void(std::ostream&)>& writeTo) {
    if (path.empty()) {
        throw InputError("A file for ParaView needs a name.");
    }
    ResultFile(path).write(writeTo);
}

// --- Arrays --------------------------------------------------------------------------------------

template <class Number>
constexpr std::string_view typeName() {
    if constexpr (std::is_same_v<Number, float>) {
        return "Float32";
    } else if constexpr (std::is_same_v<Number, std::uint32_t>) {
        return "UInt32";
    } else if constexpr (std::is_same_v<Number, std::uint64_t>) {
        return "UInt64";
    } else {
        static_assert(std::is_same_v<Number, std::int64_t>);
        return "Int64";
    }
}

struct DataArray {
    std::string_view name;
    std::string_view type;
    std::uint64_t components;
    std::uint64_t byteCount;
    std::function<void(std::ostream&)> write;  // so many bytes
};

/// The numbers of blockAt(0), ..., blockAt(count - 1), each of which is a std::array.
template <class BlockAt>
DataArray blocks(std::string_view name, std::size_t count, BlockAt blockAt,
                 std::uint64_t components = 1) {
    using Block = std::invoke_result_t<BlockAt, std::size_t>;
    const auto write = [count, blockAt](std::ostream& out) {
        std::array<Block, 256> buffer;
        for (std::size_t first = 0; first < count; first += buffer.size()) {
            const std::size_t length = std::min(buffer.size(), count - first);
            for (std::size_t i = 0; i < length; ++i) {
                buffer[i] = blockAt(first + i);
            }
            out.write(reinterpret_cast<const char*>(buffer.data()),
                      static_cast<std::streamsize>(length * sizeof(Block)));
        }
    };
    return {name, typeName<typename Block::value_type>(), components, count * sizeof(Block), write};
}

/// The fields of so many points or boxes, with each number repeated.
template <std::size_t kCopies>
std::vector<DataArray> fieldArrays(std::span<const VtkField> fields, std::size_t count) {
    std::vector<DataArray> arrays;
    for (const VtkField& field : fields) {
        const auto add = [&arrays, &field, count](auto numbers) {
            using Number = typename decltype(numbers)::value_type;
            if (numbers.size() != count) {
                throw std::invalid_argument("The field '" + std::string(field.name) + "' has " +
                                            std::to_string(numbers.size()) +
                                            " numbers instead of " + std::to_string(count) + ".");
            }
            arrays.push_back(blocks(field.name, count, [numbers](std::size_t i) {
                std::array<Number, kCopies> copies;
                copies.fill(numbers[i]);
                return copies;
            }));
        };
        std::visit(add, field.numbers);
    }
    return arrays;
}

/// Where the list of points of each cell ends: kPoints after the one before.
template <std::size_t kPoints>
DataArray cellEnds(std::size_t cellCount) {
    return blocks("offsets", cellCount, [](std::size_t cell) {
        return std::array{static_cast<std::int64_t>(kPoints * (cell + 1))};
    });
}

// --- Poly data -----------------------------------------------------------------------------------

struct Section {
    std::string name;
    std::vector<DataArray> arrays;
};

/// Writes a .vtp file of one piece, whose attributes are the counts of its points and cells.
void writePolyData(const std::string& path, const std::string& counts,
                   const std::vector<Section>& sections) {
    std::string xml = opening("PolyData") + "<PolyData>\n<Piece" + counts + ">\n";
    std::uint64_t offset = 0;
    for (const auto& [name, arrays] : sections) {
        xml += "<" + name + ">\n";
        for (const DataArray& array : arrays) {
            xml += "<DataArray" + attribute("type", array.type) + attribute("Name", array.name) +
                   attribute("NumberOfComponents", array.components) +
                   attribute("format", "appended") + attribute("offset", offset) + "/>\n";
            offset += sizeof(std::uint64_t) + array.byteCount;
        }
        xml += "</" + name + ">\n";
    }
    xml += "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";
    writeFile(path, [&xml, &sections](std::ostream& out) {
        out << xml;
        for (const Section& section : sections) {
            for (const DataArray& array : section.arrays) {
                const auto length = std::bit_cast<std::array<char, 8>>(array.byteCount);
                out.write(length.data(), length.size());
                array.write(out);
            }
        }
        out << "\n</AppendedData>\n</VTKFile>\n";
    });
}

/// Corner c of a box has the maximum of axis k where bit k of c is set.
VtkPoint cornerOf(const VtkBox& box, std::size_t corner) {
    VtkPoint point;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        point[axis] = ((corner >> axis) & 1U) != 0 ? box.max[axis] : box.min[axis];
    }
    return point;
}

/// The corners of the six quads, each counterclockwise for who looks from outside.
constexpr std::array<std::int64_t, 24> kQuads = {0, 4, 6, 2, 1, 3, 7, 5,   // -x, +x
                                                 0, 1, 5, 4, 2, 6, 7, 3,   // -y, +y
                                                 0, 2, 3, 1, 4, 5, 7, 6};  // -z, +z

}  // namespace

void writeVtkPoints(const std::string& path, std::span<const VtkPoint> points,
                    std::span<const VtkField> fields) {
    const std::size_t count = points.size();
    const auto pointAt = [points](std::size_t i) { return points[i]; };
    const auto itself = [](std::size_t i) { return std::array{static_cast<std::int64_t>(i)}; };
    writePolyData(path, attribute("NumberOfPoints", count) + attribute("NumberOfVerts", count),
                  {{"PointData", fieldArrays<1>(fields, count)},
                   {"Points", {blocks("Points", count, pointAt, 3)}},
                   {"Verts", {blocks("connectivity", count, itself), cellEnds<1>(count)}}});
}

void writeVtkBoxes(const std::string& path, std::span<const VtkBox> boxes,
                   std::span<const VtkField> fields) {
    const std::size_t count = boxes.size();
    const auto cornersAt = [boxes](std::size_t i) {
        std::array<VtkPoint, 8> corners;
        for (std::size_t corner = 0; corner < corners.size(); ++corner) {
            corners[corner] = cornerOf(boxes[i], corner);
        }
        return std::bit_cast<std::array<float, 24>>(corners);
    };
    const auto quadsAt = [](std::size_t i) {
        std::array<std::int64_t, 24> quads = kQuads;
        for (std::int64_t& point : quads) {
            point += static_cast<std::int64_t>(8 * i);
        }
        return quads;
    };
    writePolyData(path,
                  attribute("NumberOfPoints", 8 * count) + attribute("NumberOfPolys", 6 * count),
                  {{"CellData", fieldArrays<6>(fields, count)},
                   {"Points", {blocks("Points", count, cornersAt, 3)}},
                   {"Polys", {blocks("connectivity", count, quadsAt), cellEnds<4>(6 * count)}}});
}

void writeVtkPieces(const std::string& path, VtkPieceKind kind,
                    std::span<const std::string> pieceNames, std::span<const VtkField> fields) {
    const std::string section = kind == VtkPieceKind::points ? "PPointData" : "PCellData";
    std::string xml = opening("PPolyData") + "<PPolyData GhostLevel=\"0\">\n<" + section + ">\n";
    for (const VtkField& field : fields) {
        const auto nameOf = [](auto numbers) {
            return typeName<typename decltype(numbers)::value_type>();
        };
        const std::string_view type = std::visit(nameOf, field.numbers);
        xml += "<PDataArray" + attribute("type", type) + attribute("Name", field.name) + "/>\n";
    }
    xml += "</" + section + ">\n<PPoints>\n<PDataArray" + attribute("type", typeName<float>()) +
           attribute("Name", "Points") + attribute("NumberOfComponents", 3) + "/>\n</PPoints>\n";
    for (const std::string& name : pieceNames) {
        xml += "<Piece" + attribute("Source", name) + "/>\n";
    }
    xml += "</PPolyData>\n</VTKFile>\n";
    writeFile(path, [&xml](std::ostream& out) { out << xml; });
}

void writeVtkSeries(const std::string& path, std::span<const VtkSeriesEntry> entries) {
    std::string xml = opening("Collection") + "<Collection>\n";
    for (const VtkSeriesEntry& entry : entries) {
        xml += "<DataSet" + attribute("timestep", entry.step) + attribute("file", entry.fileName) +
               "/>\n";
    }
    xml += "</Collection>\n</VTKFile>\n";
    writeFile(path, [&xml](std::ostream& out) { out << xml; });
}

}  // namespace hashphase::demos
