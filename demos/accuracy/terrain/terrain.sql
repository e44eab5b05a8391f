R"sql(-- SPDX-License-Identifier: Zlib
--
-- P9. Measured are: plan, methods, spheres (a row for each method, cell size and sphere on a ground; null
-- where no ground was found), points (of each method and place) and times (each frame, on hills).

CREATE VIEW texts AS
SELECT '48 x 48 quads of 1 m, two triangles each; spheres of 0.3 to 1 m; seed ' || seed AS mesh
FROM plan;

-- How a method puts spheres on a ground; depths and heights as shares of their radii.
CREATE TABLE rests AS
SELECT kind, slope, theory, methods.*, cell, count(*) AS spheres,
       percent(count(*) - count(depth), count(*)) AS no_ground_percent,
       count(*) - count(depth) AS no_ground, ifnull(avg(depth), 0) AS depth,
       ifnull(max(depth), 0) AS worst_depth, ifnull(avg(above), 0) AS height,
       ifnull(max(above), 0) AS worst_height,
       iif(takes_cells, method || ', ' || number(cell) || ' m cells', method) AS name
FROM spheres JOIN methods USING (method)
GROUP BY kind, slope, method, cell ORDER BY min(spheres.rowid);

-- Far above the rounding of heights to single precision, far below what anybody sees.
CREATE VIEW seen AS SELECT 1e-3 AS radii;

CREATE VIEW depth_texts AS
SELECT rests.rowid AS rest,
       'sinks in by ' || iif(depth <= radii, 'less than 0.1 % of r', number(100 * depth) || ' % of r')
       || ' (worst: '
       || iif(worst_depth <= radii, 'less than 0.1 % of r', number(100 * worst_depth) || ' % of r')
       || '); hangs '
       || iif(height <= radii, 'less than 0.1 % of r', number(100 * height) || ' % of r')
       || ' above the ground' AS depth_text
FROM rests, seen;

-- With the time of a frame, and for a sphere.
CREATE TABLE timed AS
SELECT rests.*, depth_text, median(ms) AS frame_ms, median(ms) * 1e6 / spheres_per_frame AS ns,
       percentile(ms, 0.05) * 1e6 / spheres_per_frame AS low,
       percentile(ms, 0.95) * 1e6 / spheres_per_frame AS high
FROM rests JOIN depth_texts ON rest = rests.rowid JOIN times USING (method, cell), plan
WHERE kind = 'hills' GROUP BY rests.rowid;

CREATE VIEW bullet AS SELECT * FROM timed WHERE method = 'Bullet: sphere swept down';

CREATE VIEW shown_times AS
SELECT timed.name AS "configuration: method, on hills", timed.method AS "method: kind",
       timed.ns AS "time: time per sphere [ns]", timed.low AS "low: 5th percentile [ns]",
       timed.high AS "high: 95th percentile [ns]", timed.ns / bullet.ns AS "ratio: time per sphere [times Bullet's sweep]",
       timed.depth AS "depth: mean depth [share of r]", timed.worst_depth AS "worst_depth: worst depth [share of r]",
       timed.height AS "height: mean height above [share of r]",
       timed.worst_height AS "worst_height: worst height [share of r]",
       timed.no_ground_percent AS "no_ground: no ground [%]"
FROM timed LEFT JOIN bullet ORDER BY timed.rowid;

/* {"settings": "mesh, ground, truth, points"} */
SELECT mesh || '.' FROM texts
UNION ALL VALUES
('A slope is one plane. Terraces are flat, go up, are flat, and go down, over 4 m each. Hills are random, up to 56 m high.'),
('Truth: the nearest points of all triangles, in long double, give the depth of a sphere in the ground, or its height above the ground. Checked spheres start 2 m above their rest position, timed spheres start 2 m above the highest point.'),
('Methods also find the triangle of points: points anywhere, points on shared edges (within single precision), and points on shared corners.');

/* {"table": "slopes"} */
SELECT plane.slope AS "slope: slope [degrees]", plane.method,
       plane.depth AS "depth: on a slope: mean depth [share of r]",
       plane.theory AS "theory: r (1 - n_y) [share of r]",
       terraces.depth AS "terraces: on terraces: mean depth [share of r]",
       terraces.worst_depth AS "terraces_worst: worst depth [share of r]",
       terraces.height AS "terraces_height: mean height above [share of r]"
FROM rests AS plane JOIN rests AS terraces USING (slope, method)
WHERE plane.kind = 'slope' AND terraces.kind = 'terraces' AND slope IN (0, 40, 80)
ORDER BY plane.rowid;

/* {"table": "times"} */
SELECT * FROM shown_times;

/* {"chart": "P9-slope", "title": "Depth of spheres in a slope; dashed: r (1 - n_y)",
    "settings": "{mesh}", "x": "slope", "y": "depth", "series": "method", "theory": "theory"} */
SELECT slope AS "slope: slope [degrees]", method,
       depth AS "depth: mean depth in the ground [share of r]",
       worst_depth AS "worst_depth: worst depth [share of r]",
       height AS "height: mean height above it [share of r]",
       worst_height AS "worst_height: worst height [share of r]",
       no_ground_percent AS "no_ground: no ground found [%]", theory AS "theory: r (1 - n_y) [share of r]"
FROM rests WHERE kind = 'slope' ORDER BY rowid;

/* {"chart": "P9-terraces",
    "title": "Depth of spheres in terraces: flat, up, flat and down, over 4 m each",
    "settings": "{mesh}", "x": "slope", "y": "depth", "series": "method"} */
SELECT slope AS "slope: slope [degrees]", method,
       depth AS "depth: mean depth in the ground [share of r]",
       worst_depth AS "worst_depth: worst depth [share of r]",
       height AS "height: mean height above it [share of r]",
       worst_height AS "worst_height: worst height [share of r]",
       no_ground_percent AS "no_ground: no ground found [%]", theory AS "theory: r (1 - n_y) [share of r]"
FROM rests WHERE kind = 'terraces' ORDER BY rowid;

/* {"chart": "P9-points", "title": "Points on the ground for which a method finds no triangle",
    "settings": "{mesh}; hills, vertices moved by up to 0.3 m", "mark": "point", "x": "place names",
    "y": "no_ground", "series": "method", "low": "low", "high": "high"} */
SELECT place AS "place: points", method, percent(no_ground, points) AS "no_ground: no ground found [%]",
       100 * interval_low(no_ground, points) AS "low: at least [%]",
       100 * interval_high(no_ground, points) AS "high: at most, 95 % sure [%]",
       iif(told > 0, percent(wrong, points), NULL) AS "wrong_triangle: wrong triangle [%]"
FROM points;

/* {"chart": "P9-time", "title": "Depth of spheres in hills against the time per sphere",
    "settings": "{mesh}; medians of at least 60 frames", "mark": "point", "x": "time log",
    "y": "depth log0", "series": "method", "label": "configuration", "front": true} */
SELECT * FROM shown_times;

/* {"checks": "of those that must rest, and of those that sink by the line"} */
WITH rested AS (
    SELECT *, max(max(worst_depth), max(worst_height)) AS worst, sum(spheres) AS all_spheres,
           sum(no_ground) AS lost, max(abs(depth - theory)) FILTER (WHERE kind = 'slope') AS off
    FROM rests GROUP BY method),
asked AS (
    SELECT method, sum(points) AS all_points, sum(no_ground) AS lost_points, sum(wrong) AS all_wrong
    FROM points GROUP BY method)
SELECT claim, holds, evidence FROM (
    SELECT number, 1 AS part, method || ': spheres touch the ground, within 0.001 r' AS claim,
           all_spheres > 0 AND worst <= radii AS holds,
           'off by ' || number(worst) || ' r at worst, of ' || thousands(all_spheres) || ' spheres' AS evidence
    FROM rested, seen WHERE must_rest
    UNION ALL
    SELECT number, 2, method || ' finds ground and the right triangle everywhere',
           all_points > 0 AND lost + lost_points + all_wrong = 0,
           thousands(lost + lost_points) || ' without ground, ' || thousands(all_wrong)
           || ' with a wrong triangle, of ' || thousands(all_spheres + all_points) || ' queries'
    FROM rested JOIN asked USING (method) WHERE must_rest
    UNION ALL
    SELECT number, 3, method || ': on slopes the depth is r (1 - n_y)', off <= radii,
           'off by ' || number(off) || ' r at most'
    FROM rested, seen WHERE sinks_by_line)
ORDER BY number, part;

/* {"choices": "what nobody sees is no error"} */
SELECT 'Standing on hills, ' || thousands(spheres_per_frame) || ' spheres: depth [r]', name, frame_ms,
       iif(worst_depth <= radii, 0, depth), depth_text, ours, low * spheres_per_frame / 1e6
FROM timed, plan, seen ORDER BY timed.rowid;

/* {"conclusions": "on steep terraces"} */
SELECT 'On terraces of 60 degrees, ' || method || ' ' || depth_text || '.'
FROM rests JOIN depth_texts ON rest = rests.rowid
WHERE kind = 'terraces' AND slope = 60 ORDER BY rests.rowid;

/* {"conclusions": "of points"} */
SELECT method || ', points ' || place || ': ' || thousands(no_ground) || ' without ground and '
       || thousands(wrong) || ' with a wrong triangle, of ' || thousands(points) || ' points.'
FROM points WHERE no_ground + wrong > 0;

/* {"conclusions": "of times, beside the fastest and Bullet's sweep"} */
WITH takes AS (
    SELECT *, name || ' takes ' || ms(ns) || ' ns per sphere' AS sentence FROM timed)
SELECT takes.sentence || '; the fastest method, ' || fastest.sentence
       || ifnull('; ' || sweep.sentence, '') || '.'
FROM takes JOIN (SELECT sentence, min(ns) FROM takes) AS fastest
     LEFT JOIN takes AS sweep ON sweep.method = 'Bullet: sphere swept down'
WHERE takes.ours AND NOT takes.takes_cells;
)sql"
