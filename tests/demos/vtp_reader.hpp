// SPDX-License-Identifier: Zlib
#pragma once

// A reader of .vtp files for tests, which shares nothing with the writer.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace hashphase::demos {

/// The bytes of the file.
inline std::string contentOf(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// What a VTK file of this type begins with.
inline std::string openingOf(const std::string& type) {
    const std::string order =
        std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
    return "<?xml version=\"1.0\"?>\n<VTKFile type=\"" + type + R"(" version="1.0" byte_order=")" +
           order + R"(" header_type="UInt64">)" + '\n';
}

/// A .vtp file, taken apart.
class VtpReader {
public:
    explicit VtpReader(const std::string& path) : content_(contentOf(path)) {
        const std::string mark = "<AppendedData encoding=\"raw\">\n_";
        const std::size_t place = content_.find(mark);
        EXPECT_NE(place, std::string::npos);
        EXPECT_EQ(content_.rfind(openingOf("PolyData") + "<PolyData>\n", 0), 0U) << content_;
        data_ = place + mark.size();
        xml_ = content_.substr(0, place);
    }

    /// The value of the attribute in the first tag that begins so; "none" without it.
    [[nodiscard]] std::string attribute(const std::string& tag, const std::string& name) const {
        const std::size_t begin = xml_.find("<" + tag);
        const std::size_t end = xml_.find('>', begin);
        const std::size_t place = xml_.find(" " + name + "=\"", begin);
        if (begin == std::string::npos || place >= end) {
            return "none";
        }
        const std::size_t value = place + name.size() + 3;
        return xml_.substr(value, xml_.find('"', value) - value);
    }

    [[nodiscard]] std::size_t count(const std::string& name) const {
        return std::stoul(attribute("Piece", name));
    }

    /// The numbers of the array in the section: "PointData".
    template <class Number>
    std::vector<Number> array(const std::string& section, const std::string& name,
                              const std::string& type, const std::string& components = "1") {
        const std::size_t begin = xml_.find("<" + section + ">");
        const std::size_t end = xml_.find("</" + section + ">");
        const std::string tag = "DataArray type=\"" + type + "\" Name=\"" + name + "\"";
        const std::size_t place = xml_.find("<" + tag, begin);
        EXPECT_LT(place, end) << section << " has no " << tag;
        EXPECT_EQ(attribute(tag, "format"), "appended");
        EXPECT_EQ(attribute(tag, "NumberOfComponents"), components);
        return numbersAt<Number>(std::stoul(attribute(tag, "offset")));
    }

    /// How many bytes the arrays that were read take, and how many there are.
    [[nodiscard]] std::size_t bytesRead() const { return bytesRead_; }
    [[nodiscard]] std::size_t bytesThere() const {
        const std::string end = "\n</AppendedData>\n</VTKFile>\n";
        EXPECT_EQ(content_.substr(content_.size() - end.size()), end);
        return content_.size() - end.size() - data_;
    }

private:
    template <class Number>
    std::vector<Number> numbersAt(std::size_t offset) {
        std::uint64_t length = 0;
        std::memcpy(&length, content_.substr(data_ + offset).data(), sizeof length);
        const std::string bytes = content_.substr(data_ + offset + sizeof length, length);
        EXPECT_EQ(bytes.size(), length);
        std::vector<Number> numbers(bytes.size() / sizeof(Number));
        EXPECT_EQ(bytes.size(), numbers.size() * sizeof(Number));
        std::copy(bytes.begin(), bytes.end(), reinterpret_cast<char*>(numbers.data()));
        bytesRead_ += sizeof length + bytes.size();
        return numbers;
    }

    std::string content_;
    std::string xml_;
    std::size_t data_ = 0;
    std::size_t bytesRead_ = 0;
};

}  // namespace hashphase::demos
