// SPDX-License-Identifier: Zlib
#pragma once

// What a page shows beside its report: a tab of its own, with a script of its own.
//
// Without JavaScript  the tabs' contents stand below each other, after the report.
// With it             one of them is shown; the page's address ends in #name while that is a tab's. A tab
//                     that is shown gets an event `tabshown`.

#include <string>
#include <string_view>

namespace hashphase::demos {

/// A script that goes into a page, as it was when the program was built.
struct PageScript {
    std::string_view code;
    std::string_view sha256;  // of the code, in hexadecimal digits
};

struct PageTab {
    std::string name;  // in ids and addresses: letters
    std::string title;
    std::string content;  // HTML
    std::string_view style;
    PageScript script;
};

/// How a content-security policy names the script.
[[nodiscard]] std::string policyHash(const PageScript& script);

/// The style sheet of all pages.
[[nodiscard]] std::string_view pageStyle();

/// What switches between tabs.
[[nodiscard]] PageScript tabsScript();

}  // namespace hashphase::demos
