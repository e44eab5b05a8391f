// SPDX-License-Identifier: Zlib
#pragma once

#include <functional>
#include <memory>
#include <string_view>
#include <utility>

namespace hashphase::detail {

/// Who is told of each phase of a frame. May be replaced from within its own call.
class PhaseWatch {
public:
    void set(std::function<void(std::string_view)> watch) {
        watch_ = watch ? std::make_shared<Function>(std::move(watch)) : nullptr;
    }

    void tell(std::string_view phase) const {
        if (const std::shared_ptr<Function> watch = watch_) {  // lives until it returns
            (*watch)(phase);
        }
    }

private:
    using Function = std::function<void(std::string_view)>;

    std::shared_ptr<Function> watch_;
};

}  // namespace hashphase::detail
