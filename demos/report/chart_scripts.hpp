// SPDX-License-Identifier: Zlib
#pragma once

// The JavaScript that draws charts in a page, as it was bundled when the program was built.

#include <string_view>

namespace hashphase::demos {

struct ChartScripts {
    std::string_view
        code;  // Vega, Vega-Lite, vega-embed, charts.js and page.js; empty: built without
    std::string_view hash;     // of the code, as a content-security policy names it
    std::string_view whyNone;  // a sentence, where there is no code
};

[[nodiscard]] ChartScripts chartScripts();

}  // namespace hashphase::demos
