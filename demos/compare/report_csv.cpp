// SPDX-License-Identifier: Zlib
#include <demos/compare/report.hpp>

#include <ostream>

namespace hashphase::demos {

void writeCsv(const Report& report, std::ostream& out) {
    out << "broadphase,frame,measured,pairs,exact_pairs,missing,extra,stale,set_aabb_ms,"
           "calculate_ms,step_ms\n";
    for (const Result& result : report.comparison.results) {
        for (const FrameRow& row : result.rows) {
            out << result.kind->name << ',' << row.frame << ',' << (row.measured ? 1 : 0) << ','
                << row.verdict.pairs << ',' << row.verdict.exactPairs << ',' << row.verdict.missing
                << ',' << row.verdict.extra << ',' << row.verdict.stale << ',' << row.setAabbMs
                << ',' << row.calculateMs << ',';
            if (row.stepMs) {
                out << *row.stepMs;
            }
            out << '\n';
        }
    }
}

}  // namespace hashphase::demos
