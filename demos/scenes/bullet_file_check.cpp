// SPDX-License-Identifier: Zlib
#include <demos/scenes/bullet_world_file.hpp>

#include <demos/scenes/input_error.hpp>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

namespace hashphase::demos {
namespace {

constexpr std::size_t kBulletHeaderBytes = 12;

[[noreturn]] void fail(std::size_t byte, const std::string& fault) {
    throw InputError("byte " + std::to_string(byte) + ": " + fault);
}

// A cursor over the bytes that never leaves them; `what` is what it reads there.
class Cursor {
public:
    Cursor(std::string_view bytes, std::size_t position, std::string what)
        : bytes_(bytes), position_(position), what_(std::move(what)) {}

    [[nodiscard]] std::size_t position() const { return position_; }

    template <class Integer>
    [[nodiscard]] Integer read() {
        Integer value{};
        std::memcpy(&value, take(sizeof value).data(), sizeof value);
        return value;
    }

    std::string_view take(std::size_t count) {
        if (count > bytes_.size() - position_) {
            fail(bytes_.size(), "the file ends inside " + what_);
        }
        position_ += count;
        return bytes_.substr(position_ - count, count);
    }

    void expect(std::string_view tag) {
        const std::size_t place = position_;
        if (take(tag.size()) != tag) {
            fail(place, "expected '" + std::string(tag) + "' in " + what_);
        }
    }

    [[nodiscard]] std::size_t readCount() {
        const std::size_t place = position_;
        const auto count = read<std::int32_t>();
        if (count < 0 || count > 32'767) {
            fail(place, "invalid count in " + what_);
        }
        return static_cast<std::size_t>(count);
    }

    // A count, so many texts, and bytes without meaning up to a multiple of four.
    [[nodiscard]] std::vector<std::string_view> readTexts() {
        std::vector<std::string_view> texts(readCount());
        for (std::string_view& text : texts) {
            const std::size_t end = std::min(bytes_.find('\0', position_), bytes_.size());
            text = take(end - position_);
            take(1);
        }
        // Bullet rounds addresses, not offsets.
        while ((reinterpret_cast<std::uintptr_t>(bytes_.data()) + position_) % 4 != 0 &&
               position_ < bytes_.size()) {
            ++position_;
        }
        return texts;
    }

private:
    std::string_view bytes_;
    std::size_t position_;
    std::string what_;
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
        fail(0, "this is not a .bullet file: it must begin with BULLETf or BULLETd");
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

Chunk readChunk(std::string_view bytes, std::size_t place) {
    Cursor cursor(bytes, place, "a chunk's header");
    Chunk chunk{};
    chunk.place = place;
    chunk.code = cursor.take(4);
    chunk.length = cursor.read<std::int32_t>();
    cursor.take(pointerBytes(bytes));
    chunk.structure = cursor.read<std::int32_t>();
    chunk.count = cursor.read<std::int32_t>();
    if (chunk.length < 0 || chunk.count < 0) {
        fail(chunk.place, "the chunk has a negative length or count");
    }
    chunk.start = cursor.position();
    return chunk;
}

// Ends at the type table, which the format puts last.
std::vector<Chunk> readChunks(std::string_view bytes) {
    std::vector<Chunk> chunks;
    std::size_t position = kBulletHeaderBytes;
    do {
        if (position == bytes.size()) {
            fail(bytes.size(), "the file ends before its type table (DNA1)");
        }
        chunks.push_back(readChunk(bytes, position));
        const Chunk& chunk = chunks.back();
        std::string code(chunk.code);
        std::ranges::replace_if(
            code, [](unsigned char c) { return std::isprint(c) == 0; }, '?');
        Cursor data(bytes, chunk.start,
                    "chunk '" + code + "' of " + std::to_string(chunk.length) + " bytes");
        data.take(static_cast<std::size_t>(chunk.length));
        position = data.position();
    } while (chunks.back().code != "DNA1");
    return chunks;
}

Dna readDna(std::string_view bytes, const Chunk& chunk) {
    Cursor cursor(bytes.substr(0, chunk.start + static_cast<std::size_t>(chunk.length)),
                  chunk.start, "the type table (DNA1)");
    cursor.expect("SDNANAME");
    const std::size_t names = cursor.readTexts().size();
    cursor.expect("TYPE");
    const std::vector<std::string_view> types = cursor.readTexts();
    cursor.expect("TLEN");
    std::vector<std::int16_t> lengths(types.size());
    for (std::int16_t& length : lengths) {
        length = cursor.read<std::int16_t>();
    }
    cursor.take(types.size() % 2 * 2);
    cursor.expect("STRC");
    const auto isIndex = [](std::int16_t index, std::size_t count) {
        return index >= 0 && static_cast<std::size_t>(index) < count;
    };
    Dna dna(cursor.readCount());
    for (Structure& structure : dna) {
        const std::size_t place = cursor.position();
        const auto type = cursor.read<std::int16_t>();
        const auto fields = cursor.read<std::int16_t>();
        if (!isIndex(type, types.size()) || fields < 0) {
            fail(place, "a structure of the type table (DNA1) has no valid type");
        }
        structure = {types[static_cast<std::size_t>(type)],
                     lengths[static_cast<std::size_t>(type)]};
        for (std::int16_t field = 0; field < fields; ++field) {
            const auto fieldType = cursor.read<std::int16_t>();
            const auto fieldName = cursor.read<std::int16_t>();
            if (!isIndex(fieldType, types.size()) || !isIndex(fieldName, names)) {
                fail(cursor.position() - 4,
                     "a field of the type table (DNA1) has no valid type or name");
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
        fail(chunk.place, "the name in the chunk has no zero byte at its end");
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
        throw InputError(others.empty() ? "the world in the file has no collision objects"
                                        : "the world in the file has no collision objects, "
                                          "only " +
                                              others + ", which Bullet's importer ignores");
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
