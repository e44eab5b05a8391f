R"sql(-- SPDX-License-Identifier: Zlib
--
-- The paper's figures, as printed and as measured. What measurePaper() measures:

-- plan: a row with the settings

CREATE TABLE IF NOT EXISTS left_out (what);  -- steps, by the time limit or an interruption

-- A method at a task; part is "figure", "radius" or "cell size". A cell is null of un-optimized, which has
-- none, and of hashphase, which chooses them. Of each run: timed frames, frames that were compared with
-- brute force, and what it holds.
CREATE TABLE IF NOT EXISTS runs (part, phase, objects, radius, method, cell, side, triangles);
CREATE TABLE IF NOT EXISTS frames (run, hash_ms, stand_ms, ms);
CREATE TABLE IF NOT EXISTS checks (run, timed, objects, found, fault);
CREATE TABLE IF NOT EXISTS memory (run, bytes, chosen_cell);

CREATE TABLE IF NOT EXISTS neighbours (radius, neighbours);  -- of an agent on average

-- A row for each bounding volume and frame, and one for what it found in a frame that is not timed.
CREATE TABLE IF NOT EXISTS volumes (volume, frame, candidates, passed, touching, first_ms, exact_ms);
CREATE TABLE IF NOT EXISTS volume_checks (volume, pairs, is_right);

-- --- What the paper printed ----------------------------------------------------------------------------

CREATE TABLE phases (number, phase, figure, paper_scope, scope);
INSERT INTO phases VALUES
(1, 'collision', 13, 'collision between all spheres, response and terrain traversal',
 'hashing all spheres again, finding the overlapping pairs, testing which touch and how they bounce, and finding the ground below each sphere'),
(2, 'visibility', 14, 'frustum culling and the draw calls of all visible objects',
 'hashing all spheres again, and listing the spheres that a free camera sees; nothing is drawn'),
(3, 'AI', 15, 'counting, for each object, the colours within a radius, and taking the rarest',
 'hashing all spheres again, counting the colours within the radius of each sphere, and taking the rarest; hashphase chooses its AI cells from the radius, in every column');

-- Frames a second on a Pentium 4, 3.2 GHz: un-optimized, then with cells of 5 to 100 m. "60+" is at least
-- 60, "<1" below 1: what was measured is not known, so these never become numbers. The last one of all is
-- printed as "<!".
CREATE TABLE printed_rows (phase, objects, unoptimized, cells5, cells10, cells25, cells50, cells100);
INSERT INTO printed_rows VALUES
('collision', 500, '60+', '60+', '60+', '60+', '60+', '60+'),
('collision', 1000, '60+', '60+', '60+', '60+', '60+', '60+'),
('collision', 2500, '25', '60+', '60+', '60+', '60+', '60+'),
('collision', 5000, '<1', '60+', '60+', '60+', '60+', '60+'),
('collision', 10000, '<1', '60+', '60+', '60+', '60+', '2'),
('collision', 20000, '<1', '60+', '60+', '50', '5', '<1'),
('collision', 50000, '<1', '29', '23', '<1', '<1', '<1'),
('visibility', 500, '60+', '60+', '60+', '60+', '60+', '60+'),
('visibility', 1000, '60+', '60+', '60+', '60+', '60+', '60+'),
('visibility', 2500, '48', '60+', '60+', '60+', '60+', '60+'),
('visibility', 5000, '16', '60+', '60+', '60+', '60+', '60+'),
('visibility', 10000, '<1', '60+', '60+', '60+', '60+', '60+'),
('visibility', 20000, '<1', '60+', '60+', '60+', '60', '49'),
('visibility', 50000, '<1', '60+', '60+', '60+', '52', '40'),
('AI', 500, '60+', '60+', '60+', '60+', '60+', '60+'),
('AI', 1000, '60+', '60+', '60+', '60+', '60+', '60+'),
('AI', 2500, '35', '60+', '60+', '60+', '60+', '60+'),
('AI', 5000, '<1', '60+', '60+', '60+', '60+', '60+'),
('AI', 10000, '<1', '60+', '60+', '24', '33', '10'),
('AI', 20000, '<1', '23', '28', '12', '<1', '<1'),
('AI', 50000, '<1', '8', '<1', '<1', '<1', '<1');

CREATE TABLE places (place, cell, title);  -- in a row of a figure
INSERT INTO places VALUES (0, NULL, 'un-optimized'), (1, 5, '5 m'), (2, 10, '10 m'), (3, 25, '25 m'),
                          (4, 50, '50 m'), (5, 100, '100 m'), (6, NULL, 'automatic');

-- "The highlighted cells indicate a computation time too slow for real-time applications": below 20.
CREATE TABLE printed AS
SELECT phase, objects, place, cell, one.value AS printed,
       iif(one.value IN ('60+', '<1'), NULL, 1.0 * one.value) AS rate,
       one.value NOT IN ('60+') AND (one.value = '<1' OR 1.0 * one.value < 20) AS is_too_slow
FROM printed_rows, json_each(json_array(unoptimized, cells5, cells10, cells25, cells50, cells100)) AS one
     JOIN places ON place = one.key;

-- --- What was measured ---------------------------------------------------------------------------------

CREATE TABLE compared AS
SELECT run, count(*) AS frames, sum(timed) AS timed, sum(objects) AS objects, count(fault) AS wrong,
       (SELECT fault FROM checks AS first WHERE first.run = checks.run AND fault IS NOT NULL
        ORDER BY rowid LIMIT 1) AS fault
FROM checks GROUP BY run;

-- The runs with their times, null where none was timed; as figures, radii and cell sizes.
CREATE TABLE timed AS
SELECT runs.rowid AS run, runs.*, figure,
       CASE WHEN cell IS NOT NULL THEN method || ', cells of ' || fixed(cell, 0) || ' m'
            WHEN method = 'hashphase' THEN method || ', automatic cells' ELSE method END AS name,
       count(ms) AS frames, median(ms) AS ms, percentile(ms, 0.05) AS low, percentile(ms, 0.95) AS high,
       1000 / median(ms) AS rate, median(hash_ms) AS hash_ms, median(stand_ms) AS stand_ms,
       median(ms - hash_ms - stand_ms) AS look_ms
FROM runs JOIN phases USING (phase) LEFT JOIN frames ON run = runs.rowid
GROUP BY runs.rowid
ORDER BY CASE part WHEN 'figure' THEN 1 WHEN 'radius' THEN 2 ELSE 3 END, number, objects, runs.rowid;

-- For JSON and CSV.
CREATE VIEW measurements AS
SELECT part, figure, timed.phase, timed.objects, method, timed.cell AS cell_m,
       iif(timed.phase = 'AI', radius, NULL) AS ai_radius_m, printed AS paper, ms AS frame_ms,
       low AS p5_ms, high AS p95_ms,
       -- Pairs file and find at once.
       iif(timed.phase = 'collision' AND method = 'hashphase', NULL, hash_ms) AS hashing_ms,
       iif(timed.phase = 'collision', stand_ms, NULL) AS ground_ms, timed.rate AS frames_per_second,
       timed.frames, coalesce(compared.frames, 0) AS checked_frames,
       coalesce(compared.timed, 0) AS checked_timed_frames,
       coalesce(compared.objects, 0) AS checked_objects, coalesce(wrong, 0) AS wrong_frames, bytes,
       iif(ms IS NULL, NULL, side) AS side_m, iif(ms IS NULL, NULL, triangles) AS triangles
FROM timed LEFT JOIN compared USING (run) LEFT JOIN memory USING (run)
     LEFT JOIN printed ON part = 'figure' AND printed.phase = timed.phase
                          AND printed.objects = timed.objects AND printed.cell IS timed.cell
                          AND (printed.cell IS NOT NULL OR method = 'un-optimized')
ORDER BY timed.rowid;

CREATE VIEW all_left_out AS
SELECT what FROM left_out
UNION ALL  -- begun, and not measured to the end
SELECT phase || ' of ' || thousands(objects) || ', ' || name FROM timed WHERE frames = 0;

-- The cells of the figures: three lines for each number of objects.
CREATE TABLE lines (line, who);
INSERT INTO lines VALUES (1, 'paper, 2005'), (2, 'paper, today'), (3, 'hashphase');

CREATE TABLE cells AS
SELECT asked.phase, asked.objects, line, who, places.place, title, printed,
       iif(line = 1, printed.rate, timed.rate) AS rate, timed.ms,
       iif(line = 3, places.place = 0, places.place = 6) AS is_blank
FROM (SELECT DISTINCT phase, objects FROM timed WHERE part = 'figure') AS asked JOIN lines JOIN places
     LEFT JOIN printed ON line = 1 AND printed.phase = asked.phase
                          AND printed.objects = asked.objects AND printed.place = places.place
     LEFT JOIN timed ON part = 'figure' AND timed.phase = asked.phase AND timed.objects = asked.objects
                        AND timed.cell IS places.cell
                        AND method = CASE WHEN line = 3 THEN 'hashphase'
                                          WHEN line = 2 AND places.place = 0 THEN 'un-optimized'
                                          WHEN line = 2 THEN 'paper''s grid' END;

-- --- How the paper's cells that are too slow for real time fare today ----------------------------------

-- `paper` and `hashphase`: whether they are fast enough. Beside un-optimized, hashphase has automatic cells.
CREATE TABLE slow AS
SELECT phase, iif(printed.place = 0, 'unoptimized', 'grid') AS columns,
       coalesce(today.rate >= 20, 0) AS paper, coalesce(ours.rate >= 20, 0) AS hashphase
FROM printed JOIN cells AS today USING (phase, objects) JOIN cells AS ours USING (phase, objects)
WHERE is_too_slow AND today.line = 2 AND today.place = printed.place
      AND ours.line = 3 AND ours.place = iif(printed.place = 0, 6, printed.place);

CREATE VIEW real_time AS
SELECT number, phase, claimed.columns, count(hashphase) AS too_slow, total(paper) AS paper,
       total(hashphase) AS hashphase
FROM phases JOIN (SELECT 'grid' AS columns UNION ALL SELECT 'unoptimized') AS claimed
     LEFT JOIN slow USING (phase, columns)
GROUP BY number, columns;

CREATE VIEW real_time_json AS
SELECT json_group_object(phase, json(tallies)) AS json
FROM (SELECT phase, json_group_object(columns, json_object(
                 'paperTooSlow', too_slow, 'paperToday', CAST(paper AS INTEGER),
                 'hashphase', CAST(hashphase AS INTEGER))) AS tallies
      FROM real_time GROUP BY number ORDER BY number);

-- Where the paper's grid is faster today than hashphase at the same cell size.
CREATE VIEW losses AS
SELECT count(*) AS compared, total(ratio > 1) AS lost, max(ratio) AS ratio, worst
FROM (SELECT ours.ms / paper.ms AS ratio,
             phase || ' of ' || thousands(objects) || ', cells of ' || paper.title AS worst
      FROM cells AS paper JOIN cells AS ours USING (phase, objects, place)
      WHERE paper.line = 2 AND ours.line = 3 AND place BETWEEN 1 AND 5
            AND paper.ms IS NOT NULL AND ours.ms IS NOT NULL);

-- Of visibility it is no comparison: the paper drew.
CREATE TABLE claimed (number, phase, columns, which, rival);
INSERT INTO claimed VALUES
(1, 'collision', 'grid', 'of collision, at the same cell size', 'the paper''s grid'),
(2, 'AI', 'grid', 'of AI, with cells chosen from the radius', 'the paper''s grid'),
(3, 'collision', 'unoptimized', 'of un-optimized collision and AI, with automatic cells', 'un-optimized'),
(3, 'AI', 'unoptimized', 'of un-optimized collision and AI, with automatic cells', 'un-optimized');

CREATE VIEW real_time_sentences AS
SELECT * FROM (
    SELECT 'Slow results ' || which || ': hashphase computes ' || sum(hashphase) || ' of ' || count(*)
           || ' in real time, ' || rival || ' on this machine ' || sum(paper) || '.' AS sentence
    FROM slow JOIN claimed USING (phase, columns) GROUP BY number ORDER BY number)
UNION ALL
SELECT 'Figure 14 is not counted: the paper''s times include drawing, and nothing is drawn here. Of its slow results, '
       || 'un-optimized computes ' || sum(paper) || ' of ' || count(*)
       || ' in real time on this machine, and hashphase ' || sum(hashphase) || '.'
FROM slow WHERE phase = 'visibility' AND columns = 'unoptimized' HAVING count(*) > 0;

-- --- What is said of it --------------------------------------------------------------------------------

CREATE TABLE claims AS  -- `holds` is null where nothing was compared
SELECT 'Every method finds what brute force finds in the same frame' AS claim,
       CASE WHEN total(wrong) > 0 THEN 0 WHEN total(compared.frames) > 0 THEN 1 END AS holds,
       coalesce(group_concat(phase || ' of ' || thousands(timed.objects) || ', ' || name || ': ' || fault,
                             '; '),
                thousands(total(compared.timed)) || ' of ' || thousands(total(timed.frames))
                || ' timed frames checked, and '
                || thousands(total(compared.frames) - total(compared.timed)) || ' untimed')
       AS evidence
FROM timed LEFT JOIN compared USING (run)
UNION ALL
SELECT 'The same sticks touch with every bounding volume', min(is_right),
       coalesce('wrong with' || group_concat(iif(is_right, NULL, ' ' || volume), ''),
                thousands(max(pairs)) || ' pairs touch')
FROM volume_checks GROUP BY NULL;

-- Of a few methods, beside those that choose their cells.
CREATE VIEW times_of_most AS
SELECT phase, thousands(objects) AS objects,
       coalesce(group_concat(' ' || name || ' ' || ms(look_ms) || ' ms', ';'), '') AS looks,
       coalesce(group_concat(' ' || name || ' ' || ms(stand_ms) || ' ms', ';'), '') AS stands
FROM (SELECT phase, objects, iif(timed.frames > 0 AND (cell IS NULL OR cell = 10), name, NULL) AS name,
             look_ms, stand_ms
      FROM timed JOIN plan ON objects = most_objects WHERE part = 'figure' ORDER BY timed.rowid)
GROUP BY phase;

CREATE VIEW few_frames AS
SELECT phase, thousands(objects) AS objects, name AS method, timed.frames AS "frames: frames timed"
FROM timed JOIN plan WHERE part = 'figure' AND timed.frames BETWEEN 1 AND plan.frames - 1
ORDER BY timed.rowid;

CREATE VIEW observations AS
SELECT 'Each phase includes hashing, which a whole frame does once. Without hashing, visibility of ' || objects
       || ' objects takes' || looks || '.' AS sentence
FROM times_of_most WHERE phase = 'visibility'
UNION ALL
SELECT 'In a collision frame of ' || objects || ' objects, finding the ground takes' || stands || '.'
FROM times_of_most WHERE phase = 'collision'
UNION ALL
SELECT thousands(count(*)) || ' values of the figures are medians of fewer than ' || frames
       || ' frames, because these frames take long; the page and the CSV list these values.'
FROM few_frames, plan HAVING count(*) > 0
UNION ALL
SELECT 'At the same cell size, the paper''s grid is faster than hashphase in ' || CAST(lost AS INTEGER) || ' of '
       || compared || ' comparisons. At worst (' || worst || '), hashphase takes ' || fixed(ratio, 1)
       || ' times as long.'
FROM losses WHERE lost > 0;

CREATE VIEW how_it_was_measured AS
SELECT 'Spheres of radius 1 m roam a random terrain: up to ' || group_concat(text, '; ') || '.' AS sentence
FROM (SELECT thousands(max(objects)) || ' on ' || fixed(side, 0) || ' x ' || fixed(side, 0) || ' m with '
             || thousands(triangles) || ' triangles' AS text
      FROM runs WHERE part = 'figure' GROUP BY side ORDER BY side)
UNION ALL VALUES
('Every phase is timed separately, on one thread. Each phase includes hashing all objects again; no phase draws. Triangles are hashed once.'),
('All methods get the same frames. The bounces and colours that they find are compared, but do not affect the next frame.'),
('Un-optimized compares every pair of objects, and tests one triangle after another until it finds the triangle of a sphere. The paper''s grid is a map of square cells, cleared and filled in every frame, and hashed by multiplication and truncation. Its errors are corrected: a box is in all cells that it touches, and each pair is listed once.'),
('Visibility by the paper''s grid is for the paper''s free camera. Every cell, as high as the domain, is tested against the frustum. All objects of a cell inside the frustum are visible; the objects of a cut cell are tested themselves. The paper timed its camera from above, between two corners of the screen, and drawing.')
UNION ALL
SELECT 'AI counts ' || colours || ' colours within ' || fixed(radius, 1)
       || ' m, from centre to centre; the paper does not state its radius. hashphase chooses its AI cells from the radius: a fixed cell size only affects hashing the objects again.'
FROM plan
UNION ALL
SELECT 'Medians of up to ' || thousands(frames) || ' different frames, '
       || iif(is_hurried, 'hashphase first, then the other methods, because the time is limited',
              'all methods in each frame, in a random order')
       || '. Slow methods get fewer frames, but at least ' || fewest_frames || '. Seed ' || seed || '.'
FROM plan
UNION ALL
SELECT 'If un-optimized does not run in the last frame of a method, at most '
       || thousands(spot_checked) || ' random objects of this frame are compared with brute force. Above '
       || thousands(most_brute_forced)
       || ' objects, un-optimized is not timed, and no frame compares more objects than this.'
FROM plan;

CREATE VIEW texts AS
SELECT thousands(sweep_objects) AS sweep_objects, thousands(sticks) AS sticks,
       'medians of up to ' || thousands(frames) || ' frames' AS medians,
       thousands((SELECT count(DISTINCT frame) FROM volumes)) AS volume_frames
FROM plan;

-- --- What is shown -------------------------------------------------------------------------------------

/* {"verdict": "real time, and whether all is right"} */
SELECT ifnull((SELECT 'In real time: ' || sum(hashphase) || ' of the paper''s ' || count(*) || ' slow results. '
               FROM slow JOIN claimed USING (phase, columns) HAVING count(*) > 0), '')
       || 'All methods found the same as brute force: '
       || CASE holds WHEN 1 THEN 'yes' WHEN 0 THEN 'NO, see above' ELSE 'not checked' END, holds
FROM (SELECT iif(min(holds) = 0 OR count(holds) = count(*), min(holds), NULL) AS holds FROM claims);

/* {"sentences": "what is compared", "section": "Whether it is right"} */
VALUES ('Brute force checks the results of every method in the same frame: pairs, bounces, heights, visible objects and colours.');

/* {"conclusions": "all", "section": "Whether it is right"} */
SELECT sentence FROM real_time_sentences
UNION ALL
SELECT sentence FROM observations
UNION ALL
SELECT 'Not checked: ' || claim || ' (' || evidence || ').' FROM claims WHERE holds IS NULL
UNION ALL
SELECT 'Left out: ' || what || '.' FROM all_left_out;

/* {"checks": "all that was compared", "section": "Whether it is right"} */
SELECT claim, holds, evidence FROM claims WHERE holds IS NOT NULL;

/* {"settings": "all", "section": "Whether it is right"} */
SELECT sentence FROM how_it_was_measured;

/* {"sentences": "scopes", "section": "Figure {:figure}: {:phase}", "each": "SELECT * FROM phases"} */
SELECT 'The paper timed ' || :paper_scope || '. Timed here: ' || :scope || '.';

/* {"graded": "Figure {:figure}, {:phase}: {:unit} by number of objects and cell size",
    "legend": ["60 frames a second or more", "20 to 60", "below 20: too slow for real time"],
    "section": "Figure {:figure}: {:phase}",
    "each": "SELECT * FROM phases, (SELECT 'frames a second' AS unit UNION ALL VALUES ('milliseconds a frame'))"} */
SELECT thousands(objects) AS objects, who AS "", title,
       CASE WHEN is_blank THEN ''
            WHEN :unit = 'milliseconds a frame' THEN CASE printed WHEN '60+' THEN '<=16.7' WHEN '<1' THEN '>1000'
                                                     ELSE ms(coalesce(ms, 1000 / rate)) END
            WHEN printed IS NOT NULL THEN printed
            WHEN rate >= 9.95 THEN thousands(rate)  -- below, the digit after the point matters
            ELSE fixed(rate, iif(rate < 0.0995, 3, 1)) END,
       CASE WHEN is_blank THEN NULL WHEN printed = '60+' OR rate >= 60 THEN 'good'
            WHEN rate >= 20 THEN 'fair' WHEN printed = '<1' OR rate < 20 THEN 'poor' END
FROM cells WHERE phase = :phase ORDER BY cells.objects, line, place;

/* {"chart": "paper-{:phase}", "title": "Time of a frame by number of objects: {:phase}",
    "settings": "{medians}, 5th to 95th percentile; one thread", "x": "objects log", "y": "ms log",
    "series": "method", "low": "low", "high": "high", "theory": "limit",
    "section": "Figure {:figure}: {:phase}", "each": "SELECT * FROM phases"} */
SELECT name AS method, objects, ms AS "ms: frame [ms]", low AS "low: 5th percentile [ms]",
       high AS "high: 95th percentile [ms]", 50.0 AS "limit: 20 frames a second: 50 ms"
FROM timed WHERE part = 'figure' AND phase = :phase AND ms IS NOT NULL AND (cell IS NULL OR cell IN (5, 100))
ORDER BY timed.method = 'hashphase', timed.method = 'paper''s grid', cell IS NULL, cell, objects;

/* {"sentences": "why", "section": "AI by radius"} */
SELECT 'The paper does not state the radius of its agents. The number of neighbours, and so the cost, grows with the square of the radius.'
FROM timed WHERE part = 'radius' LIMIT 1;

/* {"chart": "paper-radius", "title": "Time of an AI frame by radius",
    "settings": "{sweep_objects} objects; {medians}; one thread", "x": "radius log", "y": "ms log",
    "series": "method", "theory": "limit", "section": "AI by radius"} */
SELECT name AS method, radius AS "radius: radius [m]", ms AS "ms: frame [ms]",
       50.0 AS "limit: 20 frames a second: 50 ms"
FROM timed WHERE part = 'radius' AND ms IS NOT NULL
ORDER BY timed.method = 'paper''s grid', cell, timed.radius;

CREATE VIEW radii AS
SELECT timed.radius AS "radius: radius [m]", neighbours AS "neighbours: neighbours of an agent",
       max(iif(cell IS NULL, ms, NULL)) AS "hashphase, automatic cells: hashphase, automatic cells [ms]",
       max(iif(cell = 5, ms, NULL)) AS "paper's grid, cells of 5 m: paper's grid, cells of 5 m [ms]",
       max(iif(cell = 25, ms, NULL)) AS "paper's grid, cells of 25 m: paper's grid, cells of 25 m [ms]"
FROM timed LEFT JOIN neighbours USING (radius) WHERE part = 'radius' GROUP BY timed.radius;

/* {"table": "radii", "section": "AI by radius"} */
SELECT * FROM radii;

/* {"print": "AI of {sweep_objects} by radius"} */
SELECT * FROM radii;

/* {"sentences": "why", "section": "Cell size: time against memory"} */
SELECT 'The paper expects small cells to be fast and to take more memory, because objects span more cells. The paper leaves the trade-off open. hashphase stores each object once, so its memory does not depend on the cell size; it sorts the objects of crowded cells.'
FROM timed WHERE part = 'cell size' LIMIT 1;

/* {"conclusions": "what hashphase chooses", "section": "Cell size: time against memory"} */
SELECT 'Hashphase chooses cells of ' || fixed(chosen_cell, 1) || ' m, and takes ' || ms(ms)
       || ' ms a frame and ' || bytes(bytes) || '.'
FROM timed JOIN memory USING (run) WHERE part = 'cell size' AND method = 'hashphase' AND cell IS NULL;

-- Automatic cells have the size that was chosen.
CREATE VIEW cell_sizes AS
SELECT iif(cell IS NULL, name, method) AS method, coalesce(cell, chosen_cell) AS "cell: cell [m]",
       ms AS "ms: frame [ms]", low AS "low: 5th percentile [ms]", high AS "high: 95th percentile [ms]",
       bytes / 1048576.0 AS "mebibytes: memory [MiB]"
FROM timed JOIN memory USING (run) WHERE part = 'cell size'
ORDER BY timed.method = 'hashphase', timed.rowid;

/* {"chart": "paper-cell-time", "title": "Time of a collision frame by cell size",
    "settings": "{sweep_objects} objects; {medians}, 5th to 95th percentile; one thread", "x": "cell log",
    "y": "ms log", "series": "method", "low": "low", "high": "high", "theory": "limit",
    "section": "Cell size: time against memory"} */
SELECT *, 50.0 AS "limit: 20 frames a second: 50 ms" FROM cell_sizes;

/* {"chart": "paper-cell-memory", "title": "Memory of the collision phase by cell size",
    "settings": "{sweep_objects} objects; all memory of a method, including its pairs and its terrain",
    "x": "cell log", "y": "mebibytes log", "series": "method",
    "section": "Cell size: time against memory"} */
SELECT * FROM cell_sizes;

/* {"print": "Collision of {sweep_objects} by cell size"} */
SELECT * FROM cell_sizes;

/* {"sentences": "what", "section": "Bounding volumes as a first pass"} */
SELECT 'Sticks of 4 m, 0.4 m thick, turn in space. The grid holds the box of each volume. Pairs of overlapping boxes are candidates; pairs of overlapping volumes pass; the exact test finds the pairs that touch. A tight volume passes fewer false pairs, but takes longer to compare.'
FROM volumes LIMIT 1;

CREATE VIEW bounding_volumes AS
SELECT volume AS "volume: first pass by", avg(candidates) AS "candidates: pairs from the grid",
       avg(passed) AS "passed: pairs that pass", avg(passed) - avg(touching) AS "false: false pairs: pass, but do not touch",
       avg(touching) AS "touching: pairs that touch", median(first_ms) AS "first_ms: first pass [ms]",
       median(exact_ms) AS "exact_ms: exact test [ms]",
       median(first_ms) + median(exact_ms) AS "ms: together [ms]"
FROM volumes GROUP BY volume ORDER BY min(rowid);

/* {"chart": "paper-volumes-pairs", "title": "False pairs: they pass, but do not touch",
    "settings": "{sticks} sticks, 30 m^3 for each; means of {volume_frames} frames", "mark": "bar",
    "x": "volume names", "y": "false", "section": "Bounding volumes as a first pass"} */
SELECT * FROM bounding_volumes;

/* {"chart": "paper-volumes-time", "title": "Time of a frame, including the exact test",
    "settings": "{sticks} sticks, 30 m^3 for each; medians of up to {volume_frames} frames; one thread",
    "mark": "bar", "x": "volume names", "y": "ms", "section": "Bounding volumes as a first pass"} */
SELECT * FROM bounding_volumes;

/* {"table": "volumes", "section": "Bounding volumes as a first pass"} */
SELECT * FROM bounding_volumes;

/* {"print": "{sticks} sticks that turn, by bounding volume"} */
SELECT * FROM bounding_volumes;

/* {"sentences": "the others", "section": "What was timed in fewer frames"} */
SELECT 'Everything else was timed in ' || thousands(frames) || ' different frames.'
FROM plan WHERE EXISTS (SELECT * FROM few_frames);

/* {"table": "few frames", "section": "What was timed in fewer frames"} */
SELECT * FROM few_frames;
)sql"
