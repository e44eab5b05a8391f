// SPDX-License-Identifier: Zlib
#include <demos/scenes/bullet_file_check.hpp>

#include <demos/scenes/input_error.hpp>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <vector>

namespace hashphase::demos {
namespace {

constexpr std::size_t kBulletHeaderBytes = 12;

[[noreturn]] void fail(std::size_t byte, const std::string& fault) {
    throw InputError("byte " + std::to_string(byte) + ": " + fault);
}

// A cursor over the bytes that never leaves them.
class Cursor {
public:
    Cursor(std::string_view bytes, std::size_t position) : bytes_(bytes), position_(position) {}

    [[nodiscard]] std::size_t position() const { return position_; }

    template <class Integer>
    [[nodiscard]] Integer read(const char* what) {
        Integer value{};
        std::memcpy(&value, take(sizeof value, what).data(), sizeof value);
        return value;
    }

    std::string_view take(std::size_t count, const char* what) {
        if (count > bytes_.size() - position_) {
            fail(bytes_.size(), std::string("the file ends inside ") + what);
        }
        position_ += count;
        return bytes_.substr(position_ - count, count);
    }

    std::string_view takeText(const char* what) {
        const std::size_t end = bytes_.find('\0', position_);
        if (end == std::string_view::npos) {
            fail(bytes_.size(), std::string("the file ends inside ") + what);
        }
        const std::string_view text = take(end - position_, what);
        ++position_;
        return text;
    }

    void expect(std::string_view tag, const char* what) {
        const std::size_t place = position_;
        if (take(tag.size(), what) != tag) {
            fail(place, std::string("expected '") + std::string(tag) + "' in " + what);
        }
    }

    // Bullet rounds addresses, not offsets, up to multiples of four.
    void align() {
        while ((reinterpret_cast<std::uintptr_t>(bytes_.data()) + position_) % 4 != 0 &&
               position_ < bytes_.size()) {
            ++position_;
        }
    }

private:
    std::string_view bytes_;
    std::size_t position_;
};

struct Chunk {
    std::string_view code;
    std::size_t place;
    std::size_t start;  // of its data
    std::int32_t length;
    std::int32_t structure;  // its type, an index into the DNA; negative for what is no structure
    std::int32_t count;
};

struct Structure {
    std::string_view name;
    std::int16_t length;  // [bytes]
};

using Dna = std::vector<Structure>;

std::size_t pointerBytes(std::string_view bytes) {
    return bytes[7] == '-' ? 8 : 4;
}

void checkHeader(std::string_view bytes) {
    if (bytes.size() < kBulletHeaderBytes) {
        fail(bytes.size(), "the file ends inside the header of 12 bytes");
    }
    if (bytes.substr(0, 7) != "BULLETf" && bytes.substr(0, 7) != "BULLETd") {
        fail(0, "this is no .bullet file: it must begin with BULLETf or BULLETd");
    }
    if (bytes[7] != '_' && bytes[7] != '-') {
        fail(7, "the pointer size must be marked by '_' (32 bits) or '-' (64 bits)");
    }
    if (bytes[8] == 'V') {
        fail(8, "the file was written on a big-endian machine, which is not supported");
    }
    if (bytes[8] != 'v') {
        fail(8, "the byte order must be marked by 'v' (little-endian)");
    }
    for (std::size_t i = 9; i < kBulletHeaderBytes; ++i) {
        if (std::isdigit(static_cast<unsigned char>(bytes[i])) == 0) {
            fail(i, "the Bullet version must be three digits");
        }
    }
}

Chunk readChunk(std::string_view bytes, Cursor& cursor) {
    Chunk chunk{};
    chunk.place = cursor.position();
    chunk.code = cursor.take(4, "a chunk's header");
    chunk.length = cursor.read<std::int32_t>("a chunk's header");
    cursor.take(pointerBytes(bytes), "a chunk's header");
    chunk.structure = cursor.read<std::int32_t>("a chunk's header");
    chunk.count = cursor.read<std::int32_t>("a chunk's header");
    if (chunk.length < 0 || chunk.count < 0) {
        fail(chunk.place, "the chunk has a negative length or count");
    }
    chunk.start = cursor.position();
    return chunk;
}

// Ends at the type table, which the format puts last.
std::vector<Chunk> readChunks(std::string_view bytes) {
    std::vector<Chunk> chunks;
    Cursor cursor(bytes, kBulletHeaderBytes);
    do {
        if (cursor.position() == bytes.size()) {
            fail(bytes.size(), "the file ends before its type table (DNA1)");
        }
        chunks.push_back(readChunk(bytes, cursor));
        std::string code(chunks.back().code);
        std::replace_if(
            code.begin(), code.end(), [](unsigned char c) { return std::isprint(c) == 0; }, '?');
        const std::string what =
            "chunk '" + code + "' of " + std::to_string(chunks.back().length) + " bytes";
        cursor.take(static_cast<std::size_t>(chunks.back().length), what.c_str());
    } while (chunks.back().code != "DNA1");
    return chunks;
}

std::size_t readCount(Cursor& cursor, const char* what) {
    const std::size_t place = cursor.position();
    const auto count = cursor.read<std::int32_t>(what);
    if (count < 0 || count > 32'767) {
        fail(place, std::string("impossible count in ") + what);
    }
    return static_cast<std::size_t>(count);
}

Dna readDna(std::string_view bytes, const Chunk& chunk) {
    constexpr const char* kWhat = "the type table (DNA1)";
    Cursor cursor(bytes.substr(0, chunk.start + static_cast<std::size_t>(chunk.length)),
                  chunk.start);
    cursor.expect("SDNANAME", kWhat);
    const std::size_t names = readCount(cursor, kWhat);
    for (std::size_t i = 0; i < names; ++i) {
        cursor.takeText(kWhat);
    }
    cursor.align();
    cursor.expect("TYPE", kWhat);
    const std::size_t types = readCount(cursor, kWhat);
    std::vector<std::string_view> typeNames;
    for (std::size_t i = 0; i < types; ++i) {
        typeNames.push_back(cursor.takeText(kWhat));
    }
    cursor.align();
    cursor.expect("TLEN", kWhat);
    std::vector<std::int16_t> lengths;
    for (std::size_t i = 0; i < types; ++i) {
        lengths.push_back(cursor.read<std::int16_t>(kWhat));
    }
    cursor.take(types % 2 * 2, kWhat);
    cursor.expect("STRC", kWhat);

    Dna dna;
    const std::size_t structs = readCount(cursor, kWhat);
    for (std::size_t i = 0; i < structs; ++i) {
        const std::size_t place = cursor.position();
        const auto type = cursor.read<std::int16_t>(kWhat);
        const auto fields = cursor.read<std::int16_t>(kWhat);
        if (type < 0 || static_cast<std::size_t>(type) >= types || fields < 0) {
            fail(place, "a structure of the type table (DNA1) names no type");
        }
        dna.push_back(
            {typeNames[static_cast<std::size_t>(type)], lengths[static_cast<std::size_t>(type)]});
        for (std::int16_t field = 0; field < fields; ++field) {
            const auto fieldType = cursor.read<std::int16_t>(kWhat);
            const auto fieldName = cursor.read<std::int16_t>(kWhat);
            if (fieldType < 0 || static_cast<std::size_t>(fieldType) >= types || fieldName < 0 ||
                static_cast<std::size_t>(fieldName) >= names) {
                fail(cursor.position() - 4, "a field of the type table (DNA1) names no type");
            }
        }
    }
    return dna;
}

// What is no structure, which Bullet leaves as it is: names, and arrays of plain numbers.
bool isPlain(const Chunk& chunk) {
    return chunk.structure < 0;
}

// Of one element [bytes].
std::int64_t elementLength(std::string_view bytes, const Chunk& chunk, const Dna& dna) {
    const auto structure = static_cast<std::size_t>(chunk.structure);
    if (isPlain(chunk)) {
        return 1;  // at least
    }
    if (structure >= dna.size()) {
        fail(chunk.place, "the chunk's type is not in the type table");
    }
    // Bullet writes pointers to a soft body's materials, and calls them materials.
    if (chunk.code == "ARAY" && dna[structure].name == "SoftBodyMaterialData") {
        return static_cast<std::int64_t>(pointerBytes(bytes));
    }
    return dna[structure].length;
}

void checkChunk(std::string_view bytes, const Chunk& chunk, const Dna& dna) {
    const std::int64_t length = elementLength(bytes, chunk, dna);
    if (chunk.count > 0 && length <= 0) {
        fail(chunk.place, "the chunk's type has no size, but the chunk has " +
                              std::to_string(chunk.count) + " elements");
    }
    const std::int64_t needed = std::int64_t{chunk.count} * length;
    if (needed > chunk.length) {
        fail(chunk.place, "the chunk holds " + std::to_string(chunk.length) + " bytes, but its " +
                              std::to_string(chunk.count) + " elements need " +
                              std::to_string(needed));
    }
    const auto size = static_cast<std::size_t>(chunk.length);
    const bool isText = isPlain(chunk) && chunk.count > 0 && chunk.count == chunk.length;
    if (isText && bytes.substr(chunk.start, size).find('\0') == std::string_view::npos) {
        fail(chunk.place, "the name in the chunk has no end");
    }
}

// Codes of what Bullet's importer makes objects of, and of what it passes over.
bool isObject(const Chunk& chunk) {
    return !isPlain(chunk) && (chunk.code == "RBDY" || chunk.code == "COBJ");
}

std::string passedOver(const std::vector<Chunk>& chunks) {
    std::string words;
    const auto add = [&](std::string_view code, const char* one, const char* many) {
        const auto count = std::count_if(chunks.begin(), chunks.end(),
                                         [code](const Chunk& chunk) { return chunk.code == code; });
        if (count > 0) {
            words +=
                (words.empty() ? "" : " and ") + std::to_string(count) + (count == 1 ? one : many);
        }
    };
    add("MBDY", " multi-body", " multi-bodies");
    add("SBDY", " soft body", " soft bodies");
    return words;
}

void checkBulletFile(std::string_view bytes) {
    checkHeader(bytes);
    const std::vector<Chunk> chunks = readChunks(bytes);
    const Dna dna = readDna(bytes, chunks.back());
    for (const Chunk& chunk : chunks) {
        if (chunk.code != "DNA1") {
            checkChunk(bytes, chunk, dna);
        }
    }
    if (std::none_of(chunks.begin(), chunks.end(), isObject)) {
        const std::string others = passedOver(chunks);
        throw InputError(others.empty() ? "the world in it holds no collision object"
                                        : "the world in it holds " + others +
                                              ", which Bullet's importer passes over, and no "
                                              "collision object besides");
    }
}

}  // namespace

std::string bulletFileFault(std::string_view bytes) {
    try {
        checkBulletFile(bytes);
    } catch (const InputError& fault) {
        return fault.what();
    }
    return {};
}

std::string bulletFileOmissions(std::string_view bytes) {
    return passedOver(readChunks(bytes));
}

}  // namespace hashphase::demos
