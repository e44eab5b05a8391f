R"sql(-- SPDX-License-Identifier: Zlib
--
-- P6. Measured are: plan, methods, points (the distances), looks (a row for each method, distance and frame
-- that is compared, of boxes of a metre, fine, and of kilometres, whose coordinates are all exact in single
-- precision), frames (their times, without a method those of the first one at the origin); settling (methods
-- in whose worlds balls come to rest), settled (how, at a distance) and steps (their times).

CREATE VIEW texts AS
SELECT thousands(boxes) || ' moving boxes of 0.5 to 2 m within 20 m, and ' || thousands(rays)
       || ' rays, moved away from the origin by powers of two along all three axes; coordinates are '
       || 'multiples of 1/1,024 m, for half of the boxes of 1/16 m, so that many boxes just touch; 60 frames, '
       || '6 frames compared with integer arithmetic; seed ' || seed AS scene
FROM plan;

-- What a method answered at a distance, with the time of a frame.
CREATE TABLE did AS
SELECT methods.*, points.*, points.rowid AS point, sum(pairs) AS pairs,
       sum(missed_pairs) AS missed_pairs, sum(extra_pairs) AS extra_pairs, sum(hits) AS hits,
       sum(missed_hits) AS missed_hits, percent(sum(missed_pairs), sum(pairs)) AS missed_percent,
       percent(sum(extra_pairs), sum(pairs)) AS extra_percent,
       percent(sum(missed_hits), sum(hits)) AS missed_hits_percent,
       percent(sum(false_hits), sum(hits)) AS false_hits_percent, frame_ms, low_ms,
       frame_ms / origin_ms AS times
FROM looks JOIN methods USING (method) JOIN points USING (offset)
     JOIN (SELECT method, offset, median(ms) AS frame_ms, percentile(ms, 0.05) AS low_ms FROM frames
           WHERE fine GROUP BY method, offset) USING (method, offset)
     JOIN (SELECT offset, median(ms) AS origin_ms FROM frames WHERE fine AND method IS NULL
           GROUP BY offset) USING (offset)
WHERE fine GROUP BY point, number;

CREATE TABLE rested AS
SELECT settling.*, points.*, points.rowid AS point, position_error, step,
       step - first_value(step) OVER (PARTITION BY method ORDER BY points.rowid) AS later,
       state = first_value(state) OVER (PARTITION BY method ORDER BY points.rowid) AS same, step_ms, low_ms
FROM settled JOIN settling USING (method) JOIN points USING (offset)
     JOIN (SELECT method, offset, median(ms) AS step_ms, percentile(ms, 0.05) AS low_ms FROM steps
           GROUP BY method, offset) USING (method, offset)
ORDER BY point, number;

-- The point nearest to ten thousand kilometres.
CREATE TABLE far AS
SELECT rowid AS point, thousands(offset) || ' m' AS distance
FROM points ORDER BY abs(offset - 1e7), rowid LIMIT 1;

CREATE VIEW shown AS
SELECT offset AS "offset_m: distance from the origin [m]", method, pairs AS "pairs: true pairs",
       missed_pairs AS "missed: missed pairs", missed_percent AS "missed_percent: missed pairs [%]",
       ifnull(100 * interval_low(missed_pairs, pairs), 0) AS "missed_low: at least [%]",
       ifnull(100 * interval_high(missed_pairs, pairs), 100) AS "missed_high: at most [%]",
       extra_percent AS "extra_percent: false pairs [% of the true pairs]",
       hits AS "hits: true hits of rays", missed_hits AS "missed_hits: missed hits",
       missed_hits_percent AS "missed_hits_percent: missed hits [%]",
       false_hits_percent AS "false_hits_percent: false hits [% of the true hits]",
       frame_ms AS "frame_ms: frame [ms]",
       100 * (times - 1) AS "overhead_percent: extra time over float at the origin [%]"
FROM did ORDER BY point, number;

CREATE VIEW shown_rests AS
SELECT offset AS "offset_m: distance from the origin [m]", method,
       position_error AS "position_error_m: largest position error [m]",
       step AS "settle_step: settled after [steps]",
       later AS "settle_difference: settled later than at the origin by [steps]", step_ms AS "step_ms: step [ms]"
FROM rested ORDER BY point, number;

/* {"settings": "scene, truth, methods, frames"} */
SELECT scene || '.' FROM texts
UNION ALL VALUES
('Truth: integer arithmetic. The input coordinates are exact in double precision at every distance. In a second scene, all coordinates are multiples of 128 m: they are exact in single precision too.'),
('float: bounds are rounded to the nearest float. float positions: the centre is rounded, and the bounds are computed from the rounded centre, as Bullet does in single precision. Integer cell: coordinates are relative to the corner of a cell of 1,024 m; the subtraction is in double precision.'),
('A frame: convert and set all boxes, and update the pairs. The true hits of a ray are the hits of its segment before rounding.');

/* {"table": "pairs and rays"} */
SELECT * FROM shown
WHERE "offset_m: distance from the origin [m]" IN (SELECT offset FROM points WHERE in_tables);

/* {"table": "rest"} */
SELECT * FROM shown_rests
WHERE "offset_m: distance from the origin [m]" IN (SELECT offset FROM points WHERE in_tables);

/* {"chart": "P6-extra-pairs", "title": "False pairs far from the origin",
    "settings": "{scene}", "x": "offset_m log0", "y": "extra_percent log0", "series": "method"} */
SELECT * FROM shown;

/* {"chart": "P6-missed-pairs", "title": "Missed pairs far from the origin",
    "settings": "{scene}", "x": "offset_m log0", "y": "missed_percent", "series": "method",
    "low": "missed_low", "high": "missed_high"} */
SELECT * FROM shown;

/* {"chart": "P6-missed-hits", "title": "Missed hits of rays far from the origin",
    "settings": "{scene}", "x": "offset_m log0", "y": "missed_hits_percent", "series": "method"} */
SELECT * FROM shown;

/* {"chart": "P6-overhead", "title": "Cost of each method, relative to single precision at the origin",
    "settings": "{scene}", "x": "offset_m log0", "y": "overhead_percent", "series": "method"} */
SELECT * FROM shown;

/* {"chart": "P6-position-error", "title": "Position error of balls at rest",
    "settings": "16 balls dropped onto a floor, 300 steps of 1/60 s, Bullet in single precision",
    "x": "offset_m log0", "y": "position_error_m log0", "series": "method"} */
SELECT * FROM shown_rests;

/* {"checks": "of ours, over all distances"} */
WITH total AS (
    SELECT methods.*, fine, sum(pairs) AS pairs, sum(missed_pairs) AS missed_pairs,
           sum(extra_pairs) AS extra_pairs, sum(hits) AS hits, sum(missed_hits) AS missed_hits
    FROM looks JOIN methods USING (method) WHERE ours GROUP BY number, fine)
SELECT claim, holds, evidence FROM (
    SELECT number, 1 AS part, method || ' finds the same pairs at every distance' AS claim,
           missed_pairs = 0 AND extra_pairs = 0 AS holds,
           thousands(missed_pairs) || ' of ' || thousands(pairs) || ' missed, '
           || thousands(extra_pairs) || ' false' AS evidence
    FROM total WHERE fine AND exact
    UNION ALL
    SELECT number, 1, method || ' misses no pair at any distance', missed_pairs = 0,
           thousands(missed_pairs) || ' of ' || thousands(pairs)
    FROM total WHERE fine AND misses_no_pair AND NOT exact
    UNION ALL
    SELECT number, 2, method || ' misses no hit of a ray at any distance', missed_hits = 0,
           thousands(missed_hits) || ' of ' || thousands(hits)
    FROM total WHERE fine AND misses_no_hit
    UNION ALL
    SELECT number, 3,
           method || ' finds the same pairs at every distance in the scene with exact coordinates',
           missed_pairs = 0 AND extra_pairs = 0,
           thousands(missed_pairs) || ' of ' || thousands(pairs) || ' missed, '
           || thousands(extra_pairs) || ' false'
    FROM total WHERE NOT fine)
ORDER BY number, part;

/* {"checks": "of balls"} */
SELECT method || ': balls rest within 1 mm of the correct position, in the same state at every distance',
       max(position_error) <= 1e-3 AND min(same),
       'at most ' || fixed(1000 * max(position_error), 3) || ' mm off; bit-identical state at '
       || sum(same) || ' of ' || count(*) || ' distances'
FROM rested WHERE shifts_origin GROUP BY number;

/* {"choices": "far away"} */
SELECT thousands(boxes) || ' boxes ' || distance || ' from the origin, a frame: no pair missed', method,
       frame_ms, missed_percent / 100,
       'misses ' || thousands(missed_pairs) || ' of ' || thousands(pairs) || ' pairs', ours, low_ms
FROM did JOIN far USING (point), plan ORDER BY number;

/* {"choices": "the same, by false pairs"} */
SELECT thousands(boxes) || ' boxes ' || distance || ' from the origin, a frame: no false pair', method,
       frame_ms, extra_percent / 100, fixed(extra_percent, 1) || ' % false pairs', ours, low_ms
FROM did JOIN far USING (point), plan ORDER BY number;

/* {"choices": "balls"} */
SELECT '16 balls that come to rest ' || distance || ' from the origin, a step', method, step_ms,
       position_error, 'rests ' || number(1000 * position_error) || ' mm off', ours, low_ms
FROM rested JOIN far USING (point) ORDER BY number;

/* {"conclusions": "what differences mean"} */
SELECT method || ' at the origin was timed twice in this run: the two times differ by a factor of ' || fixed(times, 2)
       || '. Ignore smaller differences.'
FROM did WHERE number = 0 AND point = 1;

/* {"conclusions": "of each method"} */
WITH begins AS (
    SELECT number, thousands(min(offset) FILTER (WHERE missed_pairs > 0)) AS missed,
           thousands(min(offset) FILTER (WHERE extra_percent > 1)) AS extra,
           thousands(min(offset) FILTER (WHERE missed_hits > 0)) AS missed_hits
    FROM did GROUP BY number)
SELECT method || ': missed pairs: ' || ifnull('from ' || begins.missed || ' m on', 'never')
       || ', more than 1 % false pairs: '
       || ifnull('from ' || begins.extra || ' m on', 'never')
       || ', missed ray hits: '
       || ifnull('from ' || begins.missed_hits || ' m on', 'never')
       || '. At ' || distance || ': ' || fixed(missed_percent, 1) || ' % of pairs missed, '
       || fixed(extra_percent, 1) || ' % false; a frame takes ' || fixed(times, 2)
       || ' times as long as float at the origin (this method at the origin: ' || fixed(at_origin, 2) || ' times).'
FROM did JOIN far USING (point) JOIN begins USING (number)
     JOIN (SELECT number, times AS at_origin FROM did WHERE point = 1) USING (number)
ORDER BY number;

/* {"conclusions": "of balls"} */
SELECT method || ': position errors of balls at rest above 1 mm: '
       || ifnull('from ' || thousands(first) || ' m on', 'never')
       || '; ' || number(1000 * position_error) || ' mm at ' || distance || ', '
       || number(1000 * at_origin) || ' mm at the origin.'
FROM rested JOIN far USING (point)
     JOIN (SELECT number, min(offset) FILTER (WHERE position_error > 1e-3) AS first,
                  min(position_error) FILTER (WHERE point = 1) AS at_origin
           FROM rested GROUP BY number) USING (number)
ORDER BY number;
)sql"
