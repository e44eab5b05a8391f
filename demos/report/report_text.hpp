// SPDX-License-Identifier: Zlib
#pragma once

// What all reports for people have in common.

#include <demos/report/data_table.hpp>
#include <demos/report/provenance.hpp>

#include <broadphase/aabb.hpp>

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace hashphase::demos {

struct Console;

/// "3.14x", "16.4x"; "-" for none.
[[nodiscard]] std::string ratioText(const std::optional<double>& ratio);

/// "[0 0 0 to 1 1 1]", with enough digits to tell any two floats apart.
[[nodiscard]] std::string boxText(const Aabb<float>& box);

/// ". Unknown: P9, P10" of the opening ". Unknown: ", ten names at most and the number of the others;
/// empty for none.
[[nodiscard]] std::string namesText(const std::string& opening,
                                    const std::vector<std::string>& names);

/// The same, "; left out for want of time: P9, P10"; after an interruption "; interrupted, which left out P9, P10".
[[nodiscard]] std::string leftOutText(const std::vector<std::string>& names);

/// A sentence after an interruption; else empty.
[[nodiscard]] std::string interruptionText();

/// All of it, a row each.
[[nodiscard]] DataTable provenanceTable(const Provenance& provenance);

/// "Other programs used 0.8 of 2 cores while this ran", if that is more than an eighth of the cores; else empty.
[[nodiscard]] std::string overloadText(const Provenance& provenance);

/// overloadText() and what follows from it, as a sentence; empty where that is.
[[nodiscard]] std::string overloadSentence(const Provenance& provenance);

/// Why times are not to be trusted, a sentence each: of a build for tests one that begins "Times mean little", and
/// overloadSentence().
[[nodiscard]] std::vector<std::string> cautionsOf(const Provenance& provenance);

/// Two lines with versions, compiler and processor, and cautionsOf().
void printProvenance(const Provenance& provenance, std::ostream& out);

// --- In lines that fit the console ---------------------------------------------------------------

void printProvenance(const Provenance& provenance, const Console& console);
void printSentences(const std::vector<std::string>& sentences, const Console& console);

/// The verdict, which programs look for: whole in a file or a pipe.
void printVerdict(const std::string& verdict, const Console& console);

}  // namespace hashphase::demos
