// SPDX-License-Identifier: Zlib
#include <tests/fuzz/operation.hpp>

#include <algorithm>
#include <cctype>
#include <sstream>

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

std::vector<std::uint8_t> bytesOf(std::span<const Operation> operations) {
    std::vector<std::uint8_t> bytes;
    for (const Operation& operation : operations) {
        bytes.push_back(operation.kind);
        bytes.insert(bytes.end(), operation.arguments.begin(), operation.arguments.end());
    }
    return bytes;
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

namespace {

bool isFaulty(const Subject& subject, const Operations& operations) {
    return !subject.play(operations, false).fault.empty();
}

// Leaves out runs of operations, long ones first, the first operation excepted.
bool leaveOutOperations(const Subject& subject, Operations& operations) {
    bool isShorter = false;
    for (std::size_t run = operations.size(); run > 0; run /= 2) {
        for (std::size_t end = operations.size(); end > run; end -= std::min(run, end)) {
            Operations fewer = operations;
            const auto last = fewer.begin() + static_cast<std::ptrdiff_t>(end);
            fewer.erase(last - static_cast<std::ptrdiff_t>(run), last);
            if (isFaulty(subject, fewer)) {
                operations = fewer;
                isShorter = true;
            }
        }
    }
    return isShorter;
}

bool lessenArguments(const Subject& subject, Operations& operations) {
    bool isLess = false;
    for (std::size_t i = 0; i < operations.size(); ++i) {
        for (std::size_t k = 0; k < Operation::kArguments; ++k) {
            const std::uint8_t present = operations[i].arguments[k];
            for (const int lesser : {0, present % 8, present / 2, present - 1}) {
                Operations attempt = operations;
                attempt[i].arguments[k] = static_cast<std::uint8_t>(std::max(lesser, 0));
                if (lesser >= 0 && lesser < operations[i].arguments[k] &&
                    isFaulty(subject, attempt)) {
                    operations = attempt;
                    isLess = true;
                }
            }
        }
    }
    return isLess;
}

}  // namespace

Operations shrunk(const Subject& subject, Operations operations) {
    operations.resize(std::min(operations.size(), subject.play(operations, false).length));
    constexpr int kMostRounds = 4;
    for (int round = 0; round < kMostRounds; ++round) {
        const bool isShorter = leaveOutOperations(subject, operations);
        const bool isLess = lessenArguments(subject, operations);
        if (!isShorter && !isLess) {
            break;
        }
    }
    return operations;
}

}  // namespace hashphase::test
