R"sql(-- SPDX-License-Identifier: Zlib
--
-- P3. Measured are: methods, trials (crowds, with cells of a size), judged (a row for each trial, method and
-- frame), times (each mean of some frames); estimates (each query) and theory, by radius / cell.

CREATE VIEW texts AS
SELECT 'Agents with boxes of 0.5 m wander over a square, by up to 1/50 of the radius per axis and frame. Each '
       || 'agent has one of four random colours, counts the colours of its neighbours, and takes the rarest '
       || '(75 % of random choices would be wrong). Time: moving all agents in the index, and taking all '
       || 'decisions; medians of 8 means, each of 8 frames in a row.' AS scene;

CREATE TABLE did AS
WITH sums AS (SELECT trial, method, count(*) AS frames, sum(neighbours) AS neighbours, sum(found) AS found,
                     sum(wrongly) AS wrongly, sum(decisions) AS decisions, sum(wrong) AS wrong,
                     sum(worse) AS worse FROM judged GROUP BY trial, method),
     medians AS (SELECT trial, method, median(ms) AS ms, percentile(ms, 0.05) AS ms_low FROM times
                 GROUP BY trial, method)
SELECT *, 1e6 * ms / agents AS ns, iif(neighbours = 0, 1, 1.0 * found / neighbours) AS recall,
       1.0 * found / (found + wrongly) AS precision,  -- null where nobody is named
       1.0 * wrong / decisions AS wrong_share,
       found = neighbours AND wrongly = 0 AND wrong = 0 AS is_right,
       iif(uses_cells, method || ', cells of ' || number(cell) || ' m', method) AS name
FROM trials JOIN sums USING (trial) JOIN methods USING (method) JOIN medians USING (trial, method)
ORDER BY trial, methods.number;

-- It has no cells, so that once in a crowd is enough.
CREATE TABLE bullet AS SELECT crowd, ns AS bullet_ns FROM did WHERE origin = 'bullet' GROUP BY crowd;

CREATE VIEW results AS
SELECT crowd, method, iif(uses_cells, ratio, NULL) AS "radius_by_cell: radius [cells]",
       ns AS "ns: time [ns/agent]", ns * decisions / neighbours AS "ns_neighbour: time [ns/neighbour]",
       bullet_ns / ns AS "speed: times as fast as btDbvtBroadphase",
       recall AS "recall: recall, neighbours found [share]",
       precision AS "precision: precision, neighbours among agents found [share]",
       iif(estimate, estimate_precision, NULL) AS "theory: precision in theory [share]",
       wrong_share AS "wrong: wrong decisions [share]",
       interval_low(wrong, decisions, frames) AS "wrong_low: at least [share]",
       interval_high(wrong, decisions, frames) AS "wrong_high: at most, 95 % sure [share]",
       1.0 * worse / decisions AS "worse: decisions for a more frequent colour [share]"
FROM did LEFT JOIN bullet USING (crowd) ORDER BY did.rowid;

CREATE VIEW first_results AS SELECT * FROM results WHERE crowd = (SELECT crowd FROM trials);

CREATE TABLE stated AS
SELECT estimates.ratio, sum(found) AS found, iif(sum(found) = 0, 0, 1.0 * sum(within) / sum(found)) AS share,
       precision AS theory, tenths / 10 AS stated, sum(missed) AS missed, sum(too_far) AS too_far
FROM estimates JOIN theory USING (ratio)
     JOIN (SELECT column1 AS ratio, column2 AS tenths FROM (VALUES (1, 1.0), (2, 2.0), (4, 3.0), (8, 4.0)))
          USING (ratio)
GROUP BY estimates.ratio;

/* {"settings": "scene, truth, words"} */
SELECT scene FROM texts
UNION ALL VALUES
('Truth: the distance to every other agent in double precision, for agents whose neighbouring cells all lie within the square. Coordinates are multiples of 1/256 m, so single precision decides without rounding.'),
('A right decision takes the rarest colour; if several colours are equally rare, the lowest of them.'),
('Cells: all agents whose box touches a cell that the box around the search radius touches. Cells and boxes: all agents whose box touches the box around the search radius. As printed: the paper''s half-open loop over cells. It counts no agent if the radius is smaller than a cell, and counts an agent on a cell border twice.');

/* {"chart": "P3-decisions-{:number}", "title": "Wrong decisions against time: {:crowd}",
    "settings": "{scene}", "mark": "point", "x": "ns log", "y": "wrong log0", "series": "method",
    "low": "wrong_low", "high": "wrong_high", "label": "radius_by_cell", "front": true,
    "each": "SELECT crowd, row_number() OVER (ORDER BY min(trial)) AS number FROM trials GROUP BY crowd"} */
SELECT * FROM results WHERE crowd = :crowd;

/* {"chart": "P3-recall", "title": "Recall: neighbours that are found", "settings": "{scene}",
    "x": "radius_by_cell log", "y": "recall", "series": "method"} */
SELECT * FROM first_results WHERE "radius_by_cell: radius [cells]" IS NOT NULL;

/* {"chart": "P3-precision", "title": "Precision: neighbours among the agents that are found", "settings": "{scene}",
    "x": "radius_by_cell log", "y": "precision", "series": "method", "theory": "theory"} */
SELECT * FROM first_results WHERE "radius_by_cell: radius [cells]" IS NOT NULL;

/* {"table": "the first crowd"} */
SELECT * FROM first_results;

/* {"table": "what proximity.hpp states"} */
SELECT ratio AS "radius_by_cell: estimateWithin in space: radius [cells]", found AS "found: agents found",
       share AS "precision: within the radius [share]", theory AS "theory: in theory [share]",
       stated AS "stated: as proximity.hpp states [share]", missed AS "missed: missed neighbours",
       too_far AS "too_far: agents beyond the stated distance"
FROM stated;

/* {"checks": "exact ways"} */
SELECT 'Exact methods find exactly the neighbours, and take no wrong decision',
       count(*) > 0 AND min(is_right),
       thousands(total(neighbours - found)) || ' missed and ' || thousands(total(wrongly)) || ' false of '
       || thousands(total(neighbours)) || ' neighbours, ' || thousands(total(wrong)) || ' wrong of '
       || thousands(total(decisions)) || ' decisions in ' || count(*) || ' runs'
       || coalesce('; first fault: ' || (SELECT method FROM did WHERE exact AND NOT is_right), '')
FROM did WHERE exact;

/* {"checks": "complete ways"} */
SELECT 'Cells, with or without boxes, miss no agent within the radius', total(neighbours - found) = 0,
       thousands(total(neighbours - found)) || ' of ' || thousands(total(neighbours)) || ' missed'
FROM did WHERE complete;

/* {"checks": "what proximity.hpp states"} */
SELECT 'estimateWithin in space: for radii of 1, 2, 4 and 8 cells, 1, 2, 3 and 4 in 10 found agents are within the radius',
       max(abs(share - stated)) < 0.05,  -- half a tenth
       group_concat(fixed(share, 3) || ' (theory ' || fixed(theory, 3) || ')', ', ')
FROM stated
UNION ALL
SELECT 'estimateWithin misses no agent, and finds no agent farther than sqrt(3) (radius + cell)',
       sum(missed) = 0 AND sum(too_far) = 0,
       thousands(total(missed)) || ' missed, ' || thousands(total(too_far)) || ' too far of '
       || thousands(total(found)) || ' found'
FROM stated;

/* {"choices": "by wrong decisions"} */
SELECT 'Neighbours for AI: ' || crowd, name, ms, wrong_share,
       iif(is_right, 'every neighbour, every decision right',
           number(100 * wrong_share) || ' % of decisions wrong; finds ' || number(100 * recall)
           || ' % of the neighbours'
           || coalesce('; ' || iif(precision IS NULL, NULL, number(100 * precision))
                       || ' % of the found agents are neighbours', '')),
       origin = 'ours', ms_low
FROM did;

-- The fastest exact way, and who is faster at the price of what; then how agents that ask one by one fare,
-- over all cell sizes.
/* {"conclusions": "crowd by crowd", "each": "SELECT crowd FROM trials GROUP BY crowd ORDER BY min(trial)"} */
WITH best AS (SELECT * FROM did WHERE crowd = :crowd AND exact ORDER BY ns LIMIT 1),
     faster AS (SELECT did.name || ' (' || fixed(best.ns / did.ns, 1) || 'x, '
                       || number(100 * did.wrong_share) || ' % of decisions wrong)' AS text
                FROM did JOIN best USING (crowd) WHERE did.ns < best.ns ORDER BY did.rowid)
SELECT crowd || ': the fastest exact method is ' || name || ' (' || fixed(ns, 0) || ' ns per agent).'
       || coalesce(' Faster, but inexact: ' || (SELECT group_concat(text, '; ') FROM faster) || '.',
                   ' No inexact method is faster.')
       || iif(bullet_ns IS NULL, '',
              ' btDbvtBroadphase takes ' || fixed(bullet_ns / ns, 0) || ' times as long.')
FROM best LEFT JOIN bullet USING (crowd)
UNION ALL
SELECT crowd || ', one query per agent: ' || method || ' is '
       || iif(count(*) > 1, fixed(min(bullet_ns / ns), 2) || ' to ', '') || fixed(max(bullet_ns / ns), 2)
       || ' times as fast as btDbvtBroadphase' || iif(count(*) > 1, ', depending on the cell size.', '.')
FROM did JOIN bullet USING (crowd) WHERE crowd = :crowd AND method = 'findWithin';
)sql"
