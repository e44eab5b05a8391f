R"sql(-- SPDX-License-Identifier: Zlib
--
-- P2. Beside what pairs.sql reads, trials have a population and its largest edge by the mean.

CREATE VIEW texts AS
SELECT 'Edges of 0.5-1.5 m, or of 1-1000 m (equally many of each order of magnitude). Each box overlaps about '
       || 'two others, and moves by up to a fifth of the mean edge per axis and frame. Clusters hold 1,000 '
       || 'boxes. A frame: setAabb for all boxes, and finding all pairs, including the pair cache (the '
       || 'paper''s grids keep no pair cache); medians of 60 frames.' AS scene;

-- The sizes that the grid chooses itself against the best of those that are fixed.
CREATE TABLE contests AS
WITH best AS (SELECT trial, min(ns) AS best_ns, factor AS best_factor
              FROM did WHERE origin = 'ours' AND factor IS NOT NULL GROUP BY trial)
SELECT trial, name, ns AS automatic_ns, best_ns, best_factor, ns / best_ns - 1 AS regret
FROM did LEFT JOIN best USING (trial) WHERE origin = 'ours' AND factor IS NULL ORDER BY did.rowid;

-- Of each population the largest that was tried with all ways.
CREATE TABLE showcases AS
SELECT trial, name, max(objects), replace(replace(population, ' ', '-'), ':', '-') || '-' || objects AS slug
FROM did WHERE origin <> 'ours' GROUP BY population ORDER BY trial;

/* {"settings": "scene, truth, words"} */
SELECT scene FROM texts
UNION ALL VALUES
('Truth: a sweep along one axis finds the true pairs. Brute force checks the sweep up to 20,000 objects.'),
('Levels: hashphase with finest cells of this size, and coarser levels with cells 4, 16 ... times as large. A box is on the finest level whose cells are no smaller than the box. If the cells of one level are a little larger than most boxes, these boxes share this level. Automatic: hashphase chooses the sizes. One grid: the paper''s, with one cell size for all boxes.'),
('Not measured: the paper''s grids if an object would be in more than 64 cells on average; their times if a frame compares more than 300 boxes per object; the paper''s grids and btDbvtBroadphase above 20,000 objects.');

-- Where no box is larger than a cell, each spans at most two cells an axis: its corners are all.
/* {"checks": "the paper's grids"} */
SELECT 'The paper''s corner cells miss no pair if no box is larger than a cell', total(missed) = 0,
       thousands(total(missed)) || ' of ' || thousands(total(true_pairs)) || ' missed'
FROM did WHERE NOT complete AND factor >= largest_edge;

/* {"chart": "P2-time", "title": "Time of a frame per object, by the size of the finest cells",
    "settings": "{scene}", "mark": "cell", "x": "cell names", "y": "population names", "shade": "ns log"} */
SELECT iif(factor IS NULL, 'automatic', number(factor)) AS "cell: cell [mean edges]",
       name AS "population: population, objects", ns AS "ns: time [ns/object]"
FROM did WHERE origin = 'ours';

/* {"chart": "P2-memory", "title": "Memory per object, by the size of the finest cells",
    "settings": "{scene}", "mark": "cell", "x": "cell names", "y": "population names",
    "shade": "bytes log"} */
SELECT iif(factor IS NULL, 'automatic', number(factor)) AS "cell: cell [mean edges]",
       name AS "population: population, objects", 1.0 * bytes / objects AS "bytes: memory [bytes/object]"
FROM did WHERE origin = 'ours';

CREATE VIEW regrets AS
SELECT name AS population, automatic_ns AS "automatic_ns: automatic [ns/object]",
       best_ns AS "best_ns: best fixed [ns/object]",
       number(best_factor) AS "best_cell: best cell [mean edges]",
       100 * regret AS "regret_percent: automatic is slower by [%]"
FROM contests WHERE regret IS NOT NULL;

/* {"chart": "P2-regret",
    "title": "How much slower automatic cells are than the best fixed cells (below zero: faster)",
    "settings": "{scene}", "mark": "bar", "x": "population names", "y": "regret_percent"} */
SELECT * FROM regrets;

/* {"table": "regrets"} */
SELECT * FROM regrets;

-- A row for each of `did`, under the same rowid.
CREATE TABLE shown AS
SELECT method, factor AS "cell: cell [mean edges]", ns AS "ns: time [ns/object]",
       speed AS "speed: times as fast as btDbvtBroadphase", true_pairs AS "true_pairs: true pairs checked",
       missed AS "missed: missed pairs", missed_share AS "missed_share: missed pairs [share of the true pairs]",
       low AS "missed_low: at least [share]", high AS "missed_high: at most, 95 % sure [share]",
       extra AS "false: false pairs",
       extra_share AS "false_share: false pairs per true pair",
       tested * frames / true_pairs AS "tests: boxes compared per true pair",
       1.0 * bytes / objects AS "bytes: memory [bytes/object]"
FROM results;

/* {"chart": "P2-missed-{:slug}", "title": "Missed pairs against time: {:name} boxes", "settings": "{scene}",
    "mark": "point", "x": "ns log", "y": "missed_share log0", "series": "method", "low": "missed_low",
    "high": "missed_high", "label": "cell", "front": true, "each": "SELECT * FROM showcases"} */
SELECT * FROM shown WHERE rowid IN (SELECT rowid FROM did WHERE trial = :trial);

/* {"chart": "P2-tests-{:slug}", "title": "Boxes compared for each true pair, by cell size: {:name} boxes",
    "settings": "{scene}", "x": "cell log", "y": "tests log", "series": "method",
    "each": "SELECT * FROM showcases"} */
SELECT * FROM shown WHERE rowid IN (SELECT rowid FROM did WHERE trial = :trial AND factor IS NOT NULL);

/* {"choices": "in the showcases"} */
SELECT 'All pairs of a frame: ' || name || ' boxes',
       method || iif(factor IS NULL, '', ', cells of ' || number(factor) || ' mean edges'), ms, missed_share,
       result, origin = 'ours', ms_low
FROM did WHERE trial IN (SELECT trial FROM showcases) AND ms IS NOT NULL;

/* {"conclusions": "sizes"} */
SELECT iif(count(*) = 0, 'No population was timed with automatic and fixed cells.',
           'Automatic cells against the best fixed cells, ' || count(*) || ' populations: '
           || fixed(100 * abs(median(regret)), 0) || ' % ' || iif(median(regret) < 0, 'less', 'more')
           || ' time in the median, ' || fixed(100 * abs(max(regret)), 0) || ' % '
           || iif(max(regret) < 0, 'less', 'more') || ' at worst (' || name
           || '). The goal, at most 15 %, is ' || iif(max(regret) <= 0.15, 'met.', 'missed.'))
FROM contests WHERE regret IS NOT NULL
UNION ALL
SELECT 'The worst fixed cell size takes ' || fixed(max(ns / best_ns), 1) || ' times as long as the best fixed cell size ('
       || did.name || ', cells of ' || number(factor) || ' mean edges).'
FROM did JOIN contests USING (trial) WHERE origin = 'ours' AND factor IS NOT NULL AND ns IS NOT NULL;

/* {"conclusions": "the paper's grid, and Bullet", "each": "SELECT * FROM showcases"} */
SELECT 'The paper''s grid, ' || name || ': at its best cell size, it takes '
       || fixed(min(iif(exact, ns, NULL)) / automatic_ns, 1)
       || ' times as long as automatic levels. With corner cells, as printed, it misses up to '
       || number(100 * max(missed_share)) || ' % of the pairs.'
FROM did JOIN contests USING (trial, name) WHERE trial = :trial AND origin = 'paper'
GROUP BY trial HAVING count(iif(exact, ns, NULL)) > 0 AND automatic_ns IS NOT NULL
UNION ALL
SELECT 'btDbvtBroadphase, ' || name || ': ' || fixed(bullet_ns / automatic_ns, 1)
       || ' times as long as automatic levels; ' || result || '.'
FROM bullet JOIN contests USING (trial) WHERE trial = :trial AND bullet_ns / automatic_ns IS NOT NULL;
)sql"
