// SPDX-License-Identifier: Zlib
#pragma once

// Files for ParaView, in VTK's XML formats: points, boxes, pieces of several processes, and steps.
//
// Opens with  ParaView and VTK's XML readers
// Numbers     raw bytes in this machine's order, with all their digits
// Memory      at most 64 KiB, whatever the number of points or boxes
// Misuse      std::invalid_argument for a field of another length, before the file is touched
// Failure     InputError with the path for a file that cannot be written; an older one stays as it is.
//             InputError for a name with a control character, before the file is touched

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>

namespace hashphase::demos {

using VtkPoint = std::array<float, 3>;  // x, y, z [m]

/// The corners must be finite.
struct VtkBox {
    VtkPoint min;
    VtkPoint max;
};

/// One number for each point or box.
using VtkNumbers = std::variant<std::span<const float>, std::span<const std::uint32_t>,
                                std::span<const std::uint64_t>>;

/// The fields of a file have different names, in UTF-8 without control characters.
struct VtkField {
    std::string_view name;
    VtkNumbers numbers;
};

/// Writes points as a .vtp file, each a cell of its own, so that ParaView draws it.
void writeVtkPoints(const std::string& path, std::span<const VtkPoint> points,
                    std::span<const VtkField> fields);

/// Writes boxes as a .vtp file. Each box has eight points, and six quads that face outwards. Each
/// quad has the numbers of its box. Box i has the points from 8 i on and the quads from 6 i on.
void writeVtkBoxes(const std::string& path, std::span<const VtkBox> boxes,
                   std::span<const VtkField> fields);

/// Whether writeVtkPoints() or writeVtkBoxes() wrote a piece.
enum class VtkPieceKind { points, boxes };

/// Joins .vtp files of one kind in a .pvtp file. Their names are relative to its folder. Each piece
/// must have the given fields, an empty piece too. Uses the names and types of the fields only: the
/// numbers may be missing.
void writeVtkPieces(const std::string& path, VtkPieceKind kind,
                    std::span<const std::string> pieceNames, std::span<const VtkField> fields);

/// A .vtp or .pvtp file and its step, which ParaView shows as the time.
struct VtkSeriesEntry {
    std::uint64_t step;
    std::string fileName;  // relative to the folder of the .pvd file
};

/// Lists the files of several steps in a .pvd file. Files of the same step appear together.
void writeVtkSeries(const std::string& path, std::span<const VtkSeriesEntry> entries);

}  // namespace hashphase::demos
