R"sql(-- SPDX-License-Identifier: Zlib
--
-- What `hashphase compare` shows. Measured are: run (one row), broadphases, frames (a row for each frame of
-- each broadphase), faults (the first wrong pair of each broadphase that has one), and of worlds the profiled
-- steps, with Bullet's zones of each, outer ones before inner ones.

-- Where no frame was run, no pair was wrong, or no step was profiled.
CREATE TABLE IF NOT EXISTS frames (
    name, frame, measured, pairs, exact_pairs, missing, extra, stale, set_aabb_ms, calculate_ms, step_ms);
CREATE TABLE IF NOT EXISTS faults (
    name, fault_frame, kind, first, second, first_text, second_text, objects_json, boxes_json);
CREATE TABLE IF NOT EXISTS steps (name, frame, step_ms, shape_boxes_ms);
CREATE TABLE IF NOT EXISTS zones (name, frame, within, zone, ms);

-- Over all frames, warm-up included.
CREATE TABLE counted AS
SELECT name, count(*) AS frame_count, sum(pairs) AS pairs, max(pairs) AS most_pairs,
       sum(exact_pairs) AS exact_pairs,
       sum(missing) AS missing, max(missing) AS most_missing, sum(extra) AS extra,
       max(extra) AS most_extra, sum(stale) AS stale, max(stale) AS most_stale
FROM frames GROUP BY name;

-- Medians, 5th and 95th percentiles, and the worst [ms] of the frames that are timed.
CREATE TABLE timed AS
SELECT name, median(set_aabb_ms) AS set_aabb, percentile(set_aabb_ms, 0.05) AS set_aabb_low,
       percentile(set_aabb_ms, 0.95) AS set_aabb_high, median(calculate_ms) AS calculate,
       percentile(calculate_ms, 0.05) AS calculate_low,
       percentile(calculate_ms, 0.95) AS calculate_high,
       median(set_aabb_ms + calculate_ms) AS both,
       percentile(set_aabb_ms + calculate_ms, 0.05) AS both_low,
       percentile(set_aabb_ms + calculate_ms, 0.95) AS both_high,
       max(set_aabb_ms + calculate_ms) AS both_worst, median(step_ms) AS step,
       percentile(step_ms, 0.05) AS step_low, percentile(step_ms, 0.95) AS step_high,
       max(step_ms) AS step_worst
FROM frames WHERE measured GROUP BY name;

CREATE TABLE results AS
SELECT *, (SELECT both FROM timed WHERE name = 'dbvt') / nullif(both, 0) AS speed,
       CASE WHEN exact_pairs = 0 THEN 'no' WHEN 1000 * extra < exact_pairs THEN '<0.1 % of the'
            ELSE fixed(percent(extra, exact_pairs), iif(10 * extra < exact_pairs, 1, 0)) || ' % of the'
            END || ' true pairs' AS extra_share,
       name || ': left out, creating ' || thousands(objects) || ' ' || noun || ' took more than '
       || fixed(left_out_after, 1) || ' s.' AS left_out_sentence
FROM broadphases LEFT JOIN counted USING (name) LEFT JOIN timed USING (name)
     LEFT JOIN faults USING (name), run
ORDER BY broadphases.rowid;

-- Whether no broadphase of ours missed or invented a pair; null where none of ours took part in a frame.
CREATE TABLE exactness AS
SELECT (SELECT min(kind IS NULL) FROM results WHERE ours AND frame_count > 0) AS exact;

CREATE TABLE verdict AS
SELECT thousands(objects) || ' ' || noun || ', ' || frames_done || ' frames'
       || ifnull((SELECT ': ' || group_concat(part, ', ') FROM (
              SELECT title || ' ' || ms(both) || ' ms' || iif(name = 'hash', ' a frame', '') AS part
              FROM results WHERE name IN ('hash', 'dbvt') AND both IS NOT NULL
              ORDER BY name = 'dbvt')), '')
       || ifnull((SELECT ', ' || fixed(speed, 1) || 'x' FROM results WHERE name = 'hash'), '')
       || ifnull((SELECT '; ' || title || ' lists extra pairs: ' || thousands(extra) || ' (' || extra_share || ')'
                  FROM results WHERE name = 'dbvt' AND extra > 0), '') || '; '
       || CASE WHEN frames_done = 0 THEN 'pair sets not verified: no frame was run'
               WHEN exact IS NULL THEN 'no hashphase broadphase took part'
               WHEN exact THEN 'pair sets exact in every frame: yes'
               ELSE (SELECT 'pair sets exact in every frame: NO: ''' || name || ''' first '
                            || iif(kind = 'missing', 'missed', 'falsely listed') || ' the pair '
                            || first || ', ' || second || ' in frame ' || fault_frame || '; box '
                            || first || ' is ' || first_text || ', box ' || second || ' is '
                            || second_text
                     FROM results WHERE ours AND kind IS NOT NULL LIMIT 1) END AS text
FROM run, exactness;

-- Of charts; and how many frames a point of the trace stands for.
CREATE VIEW texts AS
SELECT scene || ', ' || thousands(objects) || ' ' || noun || ', ' || (frames_done - warm_up)
       || ' frames timed after ' || warm_up || ' warm-up frames, seed ' || seed || ', one thread.' AS settings,
       removed, (max(frames_done - warm_up, 1) - 1) / 1000 + 1 AS together
FROM run;

/* {"verdict": "and whether all pair sets of ours were exact"} */
SELECT text, exact FROM verdict, exactness;

-- --- Where the time of a step goes -----------------------------------------------------------------

-- A twentieth of the steps on either side is set apart by their length, of few none: machines have fits.
CREATE TABLE usual_steps AS
SELECT name, frame, step_ms, shape_boxes_ms
FROM (SELECT *, row_number() OVER (PARTITION BY name ORDER BY step_ms, frame) AS place,
             count(*) OVER (PARTITION BY name) AS count
      FROM steps)
WHERE place > count / 20 AND place <= count - count / 20;

CREATE TABLE profiled AS
SELECT name, count(*) AS steps, avg(step_ms) AS step, avg(shape_boxes_ms) AS shape_boxes
FROM usual_steps GROUP BY name;

-- These zones hold the parts of a step. What they do themselves, and what no zone tells, is all else.
CREATE TABLE holders AS
SELECT column1 AS zone
FROM (VALUES (''), ('stepSimulation'), ('internalSingleStepSimulation'), ('performDiscreteCollisionDetection'));

CREATE TABLE zone_means AS
SELECT name, zone, min(zones.rowid) AS place, sum(ms) / steps AS ms
FROM zones JOIN usual_steps USING (name, frame) JOIN profiled USING (name)
WHERE within IN (SELECT zone FROM holders) AND zone NOT IN (SELECT zone FROM holders)
GROUP BY name, zone;

-- The parts add up to the step. updateAabbs makes the boxes of the shapes, which take any broadphase the same
-- time, and hands them to setAabb.
CREATE TABLE parts AS
SELECT name, place, 'boxes of the shapes' AS part, min(ms, shape_boxes) AS ms, 0 AS is_broadphase
FROM zone_means JOIN profiled USING (name) WHERE zone = 'updateAabbs'
UNION ALL
SELECT name, place + 0.5, 'setAabb', ms - min(ms, shape_boxes), 1
FROM zone_means JOIN profiled USING (name) WHERE zone = 'updateAabbs'
UNION ALL
SELECT name, place, zone, ms, zone = 'calculateOverlappingPairs' FROM zone_means WHERE zone <> 'updateAabbs'
UNION ALL
SELECT name, 1e18, 'all else', step - sum(ms), 0 FROM zone_means JOIN profiled USING (name) GROUP BY name;

-- Whole steps, and how much of them a broadphase that takes no time would save.
CREATE TABLE gains AS
SELECT name, step, steps, sum(ms) AS broadphase, percent(sum(ms), step) AS left_to_gain
FROM parts JOIN profiled USING (name) WHERE is_broadphase GROUP BY name;

-- A row for each part, whether or not each broadphase has it.
CREATE TABLE step_cells AS
SELECT part, name, title, ms, percent(ms, step) AS share
FROM (SELECT part, min(place) AS place FROM parts GROUP BY part)
     JOIN (SELECT broadphases.rowid AS turn, name, title, step FROM broadphases JOIN gains USING (name))
     LEFT JOIN (SELECT name, part, ms FROM parts) USING (name, part)
ORDER BY place, turn;

-- As people read it.
CREATE TABLE step_table AS
SELECT part, name, ms(ms) || ' (' || fixed(share, 1) || ' %)' AS cell FROM step_cells
UNION ALL
SELECT * FROM (SELECT 'whole step', name, ms(step) FROM broadphases JOIN gains USING (name)
               ORDER BY broadphases.rowid);

CREATE TABLE step_sentences AS
SELECT 1 AS is_of_table, 'A step by Bullet''s profile zones: ms (share). Means of ' || thousands(max(steps))
       || ' frames, repeated in separate worlds without checking pairs.' AS text
FROM gains GROUP BY NULL
UNION ALL
SELECT 0, 'Left to gain: the time of setAabb and calculateOverlappingPairs. '
          || 'Computing the boxes of the shapes takes the same time with any broadphase.'
WHERE EXISTS (SELECT 1 FROM gains)
UNION ALL
SELECT 0, text FROM (SELECT name || ': broadphase ' || ms(broadphase) || ' of ' || ms(step)
                         || ' ms; left to gain: ' || fixed(left_to_gain, 1) || ' %.' AS text
                  FROM broadphases JOIN gains USING (name) ORDER BY broadphases.rowid)
UNION ALL
SELECT 0, 'This Bullet was built without profile zones: the cost of the other parts of a step is unknown.'
WHERE EXISTS (SELECT 1 FROM steps) AND NOT EXISTS (SELECT 1 FROM zones)
UNION ALL
SELECT 0, 'No time was left to measure the other parts of a step.'
WHERE EXISTS (SELECT 1 FROM timed WHERE step IS NOT NULL) AND NOT EXISTS (SELECT 1 FROM steps);

-- --- On the terminal ------------------------------------------------------------------------------

/* {"rows": "setting"} */
SELECT scene || ': ' || description FROM run
UNION ALL
SELECT thousands(objects) || ' ' || noun || ', ' || frames_done || ' frames (the first ' || warm_up
       || ' are verified, but not timed), seed ' || seed FROM run;

/* {"rows": "stopped"} */
SELECT stopped || ' after ' || frames_done || ' of ' || frames_asked || ' frames.'
FROM run WHERE stopped IS NOT NULL;

/* {"rows": "left out"} */
SELECT left_out_sentence FROM results WHERE left_out_after IS NOT NULL;

/* {"rows": "short explanation"} */
VALUES ('Times: median ms a frame of setAabb + calculate. Speed: against dbvt. Missing and extra pairs: sum of all '
        || 'frames. --verbose prints all columns.');

/* {"rows": "explanation"} */
SELECT 'Times in ms a frame: median (5th-95th percentile). Speed: setAabb + calculate, against dbvt.'
UNION ALL
SELECT 'Pairs: mean of all frames. Missing, extra and stale pairs: sum of all frames (most in one frame).'
UNION ALL
SELECT 'Fill: ms to make the broadphase and create all objects in it.'
       || iif(EXISTS (SELECT 1 FROM broadphases WHERE remove_ms IS NOT NULL),
              ' Remove: ms to destroy ' || thousands(removed) || ' objects at the end.', '')
FROM run;

-- The columns that decide, in 80 columns, or 100 with a whole step.
/* {"rows": "short table"} */
SELECT name AS broadphase, ifnull(ms(both), '-') AS "ms a frame",
       ifnull(fixed(speed, iif(speed < 10, 2, 1)) || 'x', '-') AS speed, ms(step) AS "whole step",
       ifnull(thousands(missing), '-') AS missing,
       ifnull(thousands(extra) || iif(extra > 0, ' (' || extra_share || ')', ''), '-') AS extra
FROM results;

/* {"rows": "table"} */
SELECT name AS broadphase,
       ifnull(ms(set_aabb) || ' (' || ms(set_aabb_low) || '-' || ms(set_aabb_high) || ')', '-')
           AS "setAabb for all",
       ifnull(ms(calculate) || ' (' || ms(calculate_low) || '-' || ms(calculate_high) || ')', '-')
           AS calculate,
       ifnull(ms(both) || ' (' || ms(both_low) || '-' || ms(both_high) || ')', '-') AS both,
       ifnull(fixed(speed, iif(speed < 10, 2, 1)) || 'x', '-') AS speed,
       ms(step) || ' (' || ms(step_low) || '-' || ms(step_high) || ')' AS "whole step",
       ifnull(thousands(round(1.0 * pairs / frame_count)), '-') AS pairs,
       ifnull(thousands(missing) || iif(missing > 0, ' (' || thousands(most_missing) || ')', ''), '-')
           AS missing,
       ifnull(thousands(extra) || iif(extra > 0, ' (' || thousands(most_extra) || '; ' || extra_share || ')', ''),
              '-') AS extra,
       ifnull(thousands(stale) || iif(stale > 0, ' (' || thousands(most_stale) || ')', ''), '-') AS stale,
       coalesce(bytes(memory), iif(left_out_after IS NULL, 'n/a', '-')) AS memory,
       ifnull(ms(fill_ms), '-') AS fill, ms(remove_ms) AS remove
FROM results;

/* {"rows": "step sentences"} */
SELECT text FROM step_sentences;

/* {"rows": "step gains"} */
SELECT text FROM step_sentences WHERE NOT is_of_table;

/* {"rows": "step table", "spread": true} */
SELECT part AS "part of a step", name, cell FROM step_table;

-- --- On the page ----------------------------------------------------------------------------------

/* {"sentences": "what is counted", "section": "Are the pairs right?"} */
SELECT 'The scene: ' || description || '.' FROM run
UNION ALL
SELECT 'The numbers are sums over all frames. A missing pair overlaps but is not listed: the bodies fall through '
       || 'each other. An extra pair is listed but does not overlap: it costs time in the narrow phase. A stale '
       || 'pair is an extra pair that overlapped earlier and was not removed.'
UNION ALL
SELECT left_out_sentence FROM results WHERE left_out_after IS NOT NULL;

/* {"checks": "pairs", "section": "Are the pairs right?"} */
SELECT '''' || name || ''' lists exactly the pairs that overlap, in every frame', kind IS NULL,
       thousands(missing) || ' missing and ' || thousands(extra) || ' extra in ' || frame_count || ' frames'
FROM results WHERE ours AND frame_count > 0;

/* {"table": "pairs", "section": "Are the pairs right?"} */
SELECT name AS broadphase, title AS class, ifnull(pairs, 0) AS "pairs: listed pairs",
       ifnull(missing, 0) AS "missing: missing pairs", ifnull(extra, 0) AS "extra: extra pairs",
       percent(ifnull(extra, 0), exact_pairs) AS "extra_percent: extra pairs [% of the true pairs]",
       ifnull(stale, 0) AS "stale: stale pairs among the extra pairs"
FROM results WHERE left_out_after IS NULL;

/* {"sentences": "the unit", "section": "How long does it take?"} */
SELECT 'The times are medians of the timed frames. For setAabb and calculate together ("both"), and for the '
       || 'steps of worlds, the table also has the 95th percentile and the worst frame.';

/* {"table": "times", "section": "How long does it take?"} */
SELECT name AS broadphase, set_aabb AS "set_aabb_ms: setAabb for all [ms]",
       calculate AS "calculate_ms: calculate [ms]", both AS "both_ms: both [ms]",
       both_high AS "both_p95_ms: both, 95th percentile [ms]", both_worst AS "both_worst_ms: both, worst frame [ms]",
       speed AS "speed: times as fast as dbvt", step AS "step_ms: whole step [ms]",
       step_high AS "step_p95_ms: step, 95th percentile [ms]", step_worst AS "step_worst_ms: step, worst frame [ms]",
       fill_ms AS "fill_ms: creating all objects [ms]",
       remove_ms AS "remove_ms: removing {thousands(removed)} objects [ms]",
       memory / 1048576.0 AS "memory_mib: memory [MiB]"
FROM results WHERE left_out_after IS NULL;

/* {"sentences": "how it was profiled", "section": "Where does the time of a step go?"} */
SELECT text FROM step_sentences;

/* {"table": "parts of a step", "section": "Where does the time of a step go?", "spread": true} */
SELECT part AS "part of a step [ms, and share of the step]", name, cell FROM step_table;

/* {"chart": "compare-times",
    "title": "Time of a frame: setAabb for all objects, then calculateOverlappingPairs",
    "settings": "{settings} Medians, with the 5th to 95th percentile.", "mark": "point",
    "x": "broadphase names", "y": "frame_ms log", "series": "broadphase", "low": "p5_ms", "high": "p95_ms"} */
SELECT title AS broadphase, both AS "frame_ms: median [ms a frame]",
       both_low AS "p5_ms: 5th percentile [ms]", both_high AS "p95_ms: 95th percentile [ms]",
       both_worst AS "worst_ms: worst frame [ms]"
FROM results WHERE left_out_after IS NULL;

/* {"each": "SELECT together FROM texts WHERE together = 1",
    "chart": "compare-trace", "title": "Time of each frame",
    "settings": "{settings} setAabb for all objects, then calculateOverlappingPairs.", "mark": "line",
    "x": "frame", "y": "frame_ms log", "series": "broadphase"} */
SELECT title AS broadphase, frame, set_aabb_ms + calculate_ms AS "frame_ms: setAabb and calculate [ms]"
FROM frames JOIN broadphases USING (name) WHERE measured ORDER BY broadphases.rowid, frame;

/* {"each": "SELECT together FROM texts WHERE together > 1",
    "chart": "compare-trace", "title": "Time of the frames, in groups of {together}",
    "settings": "{settings} setAabb for all objects, then calculateOverlappingPairs. Each point is the median of {together} frames, the range is from their minimum to their maximum; --csv has each frame.",
    "mark": "line", "x": "frame", "y": "frame_ms log", "series": "broadphase", "low": "least_ms",
    "high": "most_ms"} */
SELECT title AS broadphase, min(frame) AS frame,
       median(set_aabb_ms + calculate_ms) AS "frame_ms: setAabb and calculate [ms]",
       min(set_aabb_ms + calculate_ms) AS "least_ms: minimum [ms]",
       max(set_aabb_ms + calculate_ms) AS "most_ms: maximum [ms]"
FROM frames JOIN broadphases USING (name), run WHERE measured
GROUP BY name, (frame - warm_up) / :together ORDER BY broadphases.rowid, frame;

/* {"each": "SELECT DISTINCT steps FROM gains LIMIT 1",
    "chart": "compare-steps", "title": "Where the time of a step goes", "settings": "{settings} Means.",
    "mark": "bar", "x": "part names", "y": "ms", "series": "broadphase"} */
SELECT title AS broadphase, part AS "part: part of the step", ms AS "ms: mean [ms a step]" FROM step_cells;

-- --- For programs ---------------------------------------------------------------------------------

/* {"rows": "csv"} */
SELECT name AS broadphase, frame, measured, pairs, exact_pairs, missing, extra, stale, set_aabb_ms,
       calculate_ms, step_ms
FROM frames JOIN broadphases USING (name) ORDER BY broadphases.rowid, frame;

/* {"rows": "settings"} */
SELECT scene, description, from_file AS "fromFile?", objects, frames_asked AS frames,
       warm_up AS warmUpFrames, seed || '' AS "seed{}", reference, time_limit AS timeLimitSeconds
FROM run;

-- Of each broadphase that has a time for it.
/* {"rows": "end"} */
SELECT text, exact AS "exact?", frames_done AS framesDone,
       iif(EXISTS (SELECT 1 FROM broadphases WHERE remove_ms IS NOT NULL), removed, 0) AS objectsRemoved,
       stopped IS NOT NULL AND NOT interrupted AS "timeLimitHit?", interrupted AS "interrupted?"
FROM verdict, exactness, run;

/* {"rows": "broadphases"} */
SELECT name, title, ours AS "ours?", fill_ms AS fillMs, left_out_after AS leftOutAfterSeconds,
       remove_ms AS removeMs, set_aabb AS "setAabbMs.median", set_aabb_low AS "setAabbMs.p5",
       set_aabb_high AS "setAabbMs.p95", calculate AS "calculateMs.median",
       calculate_low AS "calculateMs.p5", calculate_high AS "calculateMs.p95", both AS "bothMs.median",
       both_low AS "bothMs.p5", both_high AS "bothMs.p95", both_worst AS "bothMs.worst",
       results.step AS "stepMs.median", step_low AS "stepMs.p5", step_high AS "stepMs.p95",
       step_worst AS "stepMs.worst", speed AS speedAgainstDbvt,
       memory AS memoryBytes, ifnull(pairs, 0) AS "pairs.total", ifnull(most_pairs, 0) AS "pairs.mostInAFrame",
       ifnull(missing, 0) AS "missing.total", ifnull(most_missing, 0) AS "missing.mostInAFrame",
       ifnull(extra, 0) AS "extra.total", ifnull(most_extra, 0) AS "extra.mostInAFrame",
       ifnull(stale, 0) AS "stale.total", ifnull(most_stale, 0) AS "stale.mostInAFrame",
       fault_frame AS "firstFault.frame", kind AS "firstFault.kind", objects_json AS "firstFault.objects{}",
       boxes_json AS "firstFault.boxes{}", steps AS "profiled.steps", gains.step AS "profiled.stepMs",
       broadphase AS "profiled.broadphaseMs", left_to_gain / 100 AS "profiled.leftToGain"
FROM results LEFT JOIN gains USING (name);

/* {"rows": "step parts"} */
SELECT name, part, ms, share / 100 AS share FROM step_cells WHERE ms IS NOT NULL;

/* {"rows": "frames"} */
SELECT name, frame, measured AS "measured?", pairs, exact_pairs AS exactPairs, missing, extra, stale,
       set_aabb_ms AS setAabbMs, calculate_ms AS calculateMs, step_ms AS stepMs
FROM frames;
)sql"
