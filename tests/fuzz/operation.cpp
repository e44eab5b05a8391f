// SPDX-License-Identifier: Zlib
#include <tests/fuzz/operation.hpp>

#include <algorithm>
#include <cctype>
#include <sstream>
#include <utility>

namespace hashphase::test {

Operations operationsOf(std::span<const std::uint8_t> bytes) {
    constexpr std::size_t kBytes = 1 + Operation::kArguments;
    Operations operations;
    for (std::size_t at = 0; at < bytes.size() && operations.size() < kMostOperations;
         at += kBytes) {
        Operation operation;
        operation.kind = bytes[at];
        const auto arguments = bytes.subspan(at + 1, std::min(bytes.size() - at, kBytes) - 1);
        std::copy(arguments.begin(), arguments.end(), operation.arguments.begin());
        operations.push_back(operation);
    }
    return operations;
}

std::string asSource(const Subject& subject, std::span<const Operation> operations) {
    const Verdict verdict = subject.play(operations, true);
    std::ostringstream text;
    text << "expectNoFault(k" << static_cast<char>(std::toupper(subject.name[0]))
         << subject.name + 1 << ", {\n";
    for (std::size_t i = 0; i < operations.size(); ++i) {
        const auto& arguments = operations[i].arguments;
        const auto last = std::find_if(arguments.rbegin(), arguments.rend(),
                                       [](std::uint8_t argument) { return argument != 0; });
        text << "    {" << +operations[i].kind << ", {";
        for (auto argument = arguments.begin(); argument != last.base(); ++argument) {
            text << (argument == arguments.begin() ? "" : ", ") << +*argument;
        }
        text << "}},";
        if (i < verdict.story.size()) {
            text << "  // " << verdict.story[i];
        }
        text << '\n';
    }
    text << "});\n";
    return text.str();
}

Operations shrunk(const Subject& subject, Operations operations) {
    operations.resize(std::min(operations.size(), subject.play(operations, false).length));
    bool isLess = false;
    const auto attempt = [&](Operations fewer) {
        if (!subject.play(fewer, false).fault.empty()) {
            operations = std::move(fewer);
            isLess = true;
        }
    };
    constexpr int kMostRounds = 4;
    for (int round = 0; round < kMostRounds && (round == 0 || isLess); ++round) {
        isLess = false;
        // Leaves out runs of operations, long ones first, the first operation excepted.
        for (std::size_t run = operations.size(); run > 0; run /= 2) {
            for (std::size_t end = operations.size(); end > run; end -= std::min(run, end)) {
                Operations fewer = operations;
                const auto last = fewer.begin() + static_cast<std::ptrdiff_t>(end);
                fewer.erase(last - static_cast<std::ptrdiff_t>(run), last);
                attempt(std::move(fewer));
            }
        }
        for (std::size_t i = 0; i < operations.size(); ++i) {
            for (std::size_t k = 0; k < Operation::kArguments; ++k) {
                const std::uint8_t present = operations[i].arguments[k];
                for (const int lesser : {0, present % 8, present / 2, present - 1}) {
                    if (lesser >= 0 && lesser < operations[i].arguments[k]) {
                        Operations less = operations;
                        less[i].arguments[k] = static_cast<std::uint8_t>(lesser);
                        attempt(std::move(less));
                    }
                }
            }
        }
    }
    return operations;
}

}  // namespace hashphase::test
