// SPDX-License-Identifier: Zlib
#include <tests/benchmarks/selection.hpp>

#include <demos/console/nearest_name.hpp>
#include <demos/scenes/input_error.hpp>

#include <algorithm>
#include <regex>

namespace hashphase::benchmarks {
namespace {

using demos::InputError;

constexpr std::size_t kLargestQuick = 300;

std::vector<std::regex> compiled(const std::vector<std::string>& patterns) {
    std::vector<std::regex> expressions;
    for (const std::string& pattern : patterns) {
        try {
            expressions.emplace_back(pattern);
        } catch (const std::regex_error&) {
            throw InputError("'" + pattern + "' is no regular expression.");
        }
    }
    return expressions;
}

bool isChosen(const Benchmark& benchmark, const std::string& name,
              const std::vector<std::regex>& expressions) {
    if (expressions.empty()) {
        return !benchmark.onRequest;
    }
    return std::any_of(
        expressions.begin(), expressions.end(),
        [&name](const std::regex& expression) { return std::regex_search(name, expression); });
}

std::vector<std::size_t> sizesOf(const Benchmark& benchmark, const BenchmarkOptions& options) {
    std::vector<std::size_t> sizes = benchmark.sizes;
    if (!options.sizes.empty() && benchmark.takesOtherSizes) {
        sizes = options.sizes;
    }
    for (std::size_t& size : sizes) {
        size = std::min(size, options.quick ? kLargestQuick : benchmark.largest);
    }
    std::sort(sizes.begin(), sizes.end());
    sizes.erase(std::unique(sizes.begin(), sizes.end()), sizes.end());
    return sizes;
}

std::vector<ContestantKind> chosenKinds(const std::vector<ContestantKind>& kinds,
                                        const std::vector<std::string>& names) {
    if (names.empty()) {
        return kinds;
    }
    std::vector<std::string> known;
    for (const ContestantKind& kind : kinds) {
        known.push_back(kind.name);
    }
    for (const std::string& name : names) {
        if (std::find(known.begin(), known.end(), name) == known.end()) {
            throw InputError(demos::unknownNameSentence("contestant", name, known));
        }
    }
    std::vector<ContestantKind> chosen;
    for (const ContestantKind& kind : kinds) {
        if (std::find(names.begin(), names.end(), kind.name) != names.end()) {
            chosen.push_back(kind);
        }
    }
    return chosen;
}

std::vector<ContestantKind> contestantsOf(const Benchmark& benchmark, std::size_t objects,
                                          const std::vector<ContestantKind>& chosen,
                                          std::uint64_t seed) {
    if (benchmark.contestants) {
        return benchmark.contestants(objects, seed);
    }
    std::vector<ContestantKind> admitted;
    for (const ContestantKind& kind : chosen) {
        if (benchmark.admits(kind, objects)) {
            admitted.push_back(kind);
        }
    }
    return admitted;
}

}  // namespace

std::vector<Case> selectCases(const std::vector<Benchmark>& benchmarks,
                              const std::vector<ContestantKind>& kinds,
                              const BenchmarkOptions& options) {
    const std::vector<std::regex> expressions = compiled(options.only);
    const std::vector<ContestantKind> chosen = chosenKinds(kinds, options.contestants);
    std::vector<Case> cases;
    for (const Benchmark& benchmark : benchmarks) {
        for (const std::size_t size : sizesOf(benchmark, options)) {
            Case candidate{&benchmark, size, {}};
            if (!isChosen(benchmark, candidate.name(), expressions)) {
                continue;
            }
            candidate.contestants = contestantsOf(benchmark, size, chosen, options.seed);
            if (!candidate.contestants.empty()) {
                cases.push_back(std::move(candidate));
            }
        }
    }
    if (cases.empty()) {
        throw InputError("nothing that can be measured matches; --list says what there is.");
    }
    return cases;
}

}  // namespace hashphase::benchmarks
