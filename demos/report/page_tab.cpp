// SPDX-License-Identifier: Zlib
#include <demos/report/page_tab.hpp>

#include <demos/report/base64.hpp>

#include <charconv>
#include <vector>

namespace hashphase::demos {

std::string policyHash(const PageScript& script) {
    std::vector<std::uint8_t> bytes(script.sha256.size() / 2);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        const char* const digits = script.sha256.data() + 2 * i;
        std::from_chars(digits, digits + 2, bytes[i], 16);
    }
    return "sha256-" + base64(bytes);
}

}  // namespace hashphase::demos
