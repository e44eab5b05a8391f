R"sql(-- SPDX-License-Identifier: Zlib
--
-- What a contestant did in its case: read after each case, of which it adds the rows. Measured are:

CREATE TABLE IF NOT EXISTS cases (name, "group", description, operation, objects, operations, warm_up_frames,
                                  frames_asked);
CREATE TABLE IF NOT EXISTS contestants ("case", name, title, package, ours, fill_ms);
CREATE TABLE IF NOT EXISTS frames (contestant, frame, ms);  -- those that are not to warm up
CREATE TABLE IF NOT EXISTS checks (contestant, frame, answers, exact, missing, extra, duplicates, fault);
CREATE TABLE IF NOT EXISTS ends (contestant, dropped_out, heap_bytes, own_for_objects, own_for_pairs);
CREATE INDEX IF NOT EXISTS frames_of ON frames (contestant, frame);
CREATE INDEX IF NOT EXISTS checks_of ON checks (contestant);

-- speed: how many times as long dbvt took, the median over the frames of the ratio of both times in the
-- same frame; so are all ratios. The last ones count what is wrong in its answers.
CREATE TABLE IF NOT EXISTS did (contestant, "case", name, title, package, ours, fill_ms, operations, ms, low,
                                high, frames, speed, dropped_out, heap_bytes, own_for_objects, own_for_pairs,
                                checked, answers, exact, missing, extra, duplicates, first_fault);
INSERT INTO did
SELECT contestants.rowid, contestants.*, operations, median(ms), percentile(ms, 0.05), percentile(ms, 0.95),
       count(ms),
       (SELECT median(theirs.ms / ours.ms) FROM frames AS ours JOIN frames AS theirs USING (frame)
        WHERE ours.contestant = contestants.rowid AND ours.ms > 0 AND theirs.contestant =
              (SELECT rowid FROM contestants AS dbvt
               WHERE dbvt."case" = contestants."case" AND name = 'dbvt')),
       dropped_out, heap_bytes, own_for_objects, own_for_pairs, coalesce(checked, 0), coalesce(answers, 0),
       coalesce(exact, 0), coalesce(missing, 0), coalesce(extra, 0), coalesce(duplicates, 0),
       (SELECT fault || ' in frame ' || frame FROM checks
        WHERE contestant = contestants.rowid AND fault IS NOT NULL ORDER BY rowid LIMIT 1)
FROM contestants JOIN cases ON cases.rowid = "case" LEFT JOIN ends ON ends.contestant = contestants.rowid
     LEFT JOIN (SELECT contestant, count(*) AS checked, sum(answers) AS answers, sum(exact) AS exact,
                       sum(missing) AS missing, sum(extra) AS extra, sum(duplicates) AS duplicates
                FROM checks GROUP BY contestant) AS tallies ON tallies.contestant = contestants.rowid
     LEFT JOIN frames ON frames.contestant = contestants.rowid
WHERE "case" = (SELECT max(rowid) FROM cases) GROUP BY contestants.rowid;

CREATE VIEW IF NOT EXISTS outcomes AS
SELECT cases.rowid AS "case", cases.*, max(frames) AS frames_done,
       NOT max(ours AND missing + extra + duplicates > 0) AS ours_exact
FROM cases JOIN did ON "case" = cases.rowid GROUP BY cases.rowid;

CREATE VIEW IF NOT EXISTS case_tables AS
SELECT did.name AS contestant,
       iif(ms IS NULL, '-', ms(ms) || ' (' || ms(low) || '-' || ms(high) || ')') AS "ms a frame",
       iif(dropped_out AND ms IS NULL, 'too slow', ms * 1e6 / max(did.operations, 1)) AS ns,
       iif(speed IS NULL, '-', fixed(speed, iif(speed < 10, 2, 1)) || 'x') AS "/ dbvt",
       1.0 * answers / checked AS answers, 1.0 * missing / checked AS missing, 1.0 * extra / checked AS extra,
       1.0 * duplicates / checked AS twice, fixed(1.0 * heap_bytes / max(objects, 1), 0) AS heap,
       iif(own_for_objects IS NULL, '-', fixed(1.0 * own_for_objects / nullif(objects, 0), 0) || ' + '
           || coalesce(fixed(1.0 * own_for_pairs * checked / nullif(answers, 0), 0), '-')) AS own,
       "case", ours, first_fault
FROM did JOIN cases ON cases.rowid = "case";
)sql"
