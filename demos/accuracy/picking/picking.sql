R"sql(-- SPDX-License-Identifier: Zlib
--
-- P5. Measured are: plan, methods, rays (a row for each method and ray, that grazes a box or is long) and
-- times (each frame).

CREATE VIEW texts AS
SELECT thousands(boxes) || ' boxes of 0.25 to 1 m in a slab of 300 x 16 x 300 m, cells of 1 m, rays of '
       || '10 to 700 m, coordinates between 1024 and 2048 m, where an ulp of a float is 0.12 mm; seed '
       || seed AS slab,
       thousands(rays_per_frame) || ' grazing rays' AS rays
FROM plan;

-- What a method found of rays of a kind; of the grazed box alone, what begins with box_. Late by 1e-5 is
-- far above the rounding of a fraction in single precision.
CREATE TABLE did AS
SELECT contact, ulps, length, method, count(*) AS rays, sum(hits) AS hits, sum(missed) AS missed,
       sum(falsely) AS falsely, sum(hits > 0) AS rays_that_hit,
       count(*) FILTER (WHERE hits > 0 AND missed = hits AND falsely = 0) AS none_found,
       count(*) FILTER (WHERE hits > 0 AND ifnull(late, 1) > 0) AS wrong_nearest,
       count(*) FILTER (WHERE hits > 0 AND (late > 1e-5 OR missed = hits AND falsely = 0))
           AS far_from_nearest,
       sum(cells) AS cells, sum(boxes) AS boxes, sum(box_hit) AS box_hits,
       sum(box_hit AND NOT box_found) AS box_missed, sum(box_found AND NOT box_hit) AS box_falsely
FROM rays GROUP BY contact, ulps, length, method ORDER BY min(rowid);

-- Of all its rays that graze a box, with what one takes [ns].
CREATE TABLE grazed AS
SELECT *, iif(nearest_only OR hits = 0, NULL, percent(missed, hits)) AS missed_percent,
       percent(wrong_nearest, rays_that_hit) AS wrong_percent, frame_ms * 1e6 / rays_per_frame AS ns,
       low_ms * 1e6 / rays_per_frame AS low, high_ms * 1e6 / rays_per_frame AS high
FROM (SELECT method, sum(rays) AS rays, sum(hits) AS hits, sum(missed) AS missed,
             sum(falsely) AS falsely, sum(rays_that_hit) AS rays_that_hit,
             sum(wrong_nearest) AS wrong_nearest, sum(cells) AS cells, sum(boxes) AS boxes
      FROM did WHERE contact IS NOT NULL GROUP BY method)
     JOIN (SELECT method, median(ms) AS frame_ms, percentile(ms, 0.05) AS low_ms,
                  percentile(ms, 0.95) AS high_ms FROM times GROUP BY method) USING (method)
     JOIN methods USING (method) JOIN (SELECT rays_per_frame FROM plan)
ORDER BY number;

-- Of its longest rays.
CREATE TABLE longest AS
SELECT method, max(length) AS length, hits, missed FROM did WHERE length IS NOT NULL GROUP BY method;

CREATE VIEW shown_times AS
SELECT method, grazed.ns AS "time: time per ray [ns]", grazed.low AS "low: 5th percentile [ns]",
       grazed.high AS "high: 95th percentile [ns]", grazed.ns / bullet_ns AS "ratio: time per ray [times Bullet's]",
       missed_percent AS "missed: hits missed [%]", 1.0 * falsely / rays AS "falsely: false hits per ray",
       wrong_percent AS "wrong_nearest: wrong nearest box [% of rays]",
       iif(boxes > 0, 1.0 * cells / rays, NULL) AS "cells: cells or blocks per ray",
       iif(boxes > 0, 1.0 * boxes / rays, NULL) AS "boxes: boxes tested per ray"
FROM grazed LEFT JOIN (SELECT ns AS bullet_ns FROM grazed WHERE method = 'btDbvtBroadphase::rayTest')
ORDER BY number;

CREATE VIEW shown_lengths AS
SELECT length AS "length: length [cells]", method,
       iif(nearest_only OR hits = 0, NULL, percent(missed, hits)) AS "missed: hits missed [%]",
       iif(nearest_only, NULL, 100 * interval_low(missed, max(hits, 1))) AS "low: at least [%]",
       iif(nearest_only, NULL, 100 * interval_high(missed, max(hits, 1))) AS "high: at most, 95 % sure [%]",
       1.0 * falsely / rays AS "falsely: false hits per ray",
       percent(wrong_nearest, rays_that_hit) AS "wrong_nearest: wrong nearest box [% of rays]",
       iif(cells > 0, 1.0 * cells / rays, NULL) AS "cells: cells per ray"
FROM did JOIN methods USING (method) WHERE length IS NOT NULL ORDER BY did.rowid;

/* {"settings": "scene, truth, methods"} */
SELECT slab || '.' FROM texts
UNION ALL VALUES
('All coordinates are multiples of 2^-13 m. The truth for all boxes is computed in 128-bit integers, without rounding. Touching counts as a hit.'),
('All methods that walk through cells test boxes with RayRegion::key(). They differ only in the cells that they visit. The paper''s plane is at the middle height of all boxes.')
UNION ALL
SELECT 'Methods that visit every cell on a ray are tested with rays of up to ' || thousands(longest_cell_walk)
       || ' cells.'
FROM plan;

/* {"chart": "P5-offset-{:contact}",
    "title": "Missed hits of rays that pass the {:contact} of a box, by the distance outside the box (negative: inside)",
    "settings": "{slab}", "x": "ulps", "y": "missed", "series": "method", "low": "low", "high": "high",
    "each": "SELECT contact FROM did WHERE contact IS NOT NULL GROUP BY contact ORDER BY min(rowid)"} */
SELECT ulps AS "ulps: offset [ulp]", method,
       iif(box_hits > 0, percent(box_missed, box_hits), NULL) AS "missed: hits missed [%]",
       100 * interval_low(box_missed, box_hits) AS "low: at least [%]",
       100 * interval_high(box_missed, box_hits) AS "high: at most, 95 % sure [%]",
       percent(box_falsely, rays - box_hits) AS "falsely: false hits [%]"
FROM did JOIN methods USING (method) WHERE contact = :contact AND NOT nearest_only ORDER BY did.rowid;

/* {"chart": "P5-length", "title": "Missed boxes, by the length of rays",
    "settings": "rays from near the origin; boxes along the rays, about half of the boxes hit; edges of 1 m or one ulp of the coordinates, whichever is larger; cells of 1 m, single precision",
    "x": "length log", "y": "missed log0", "series": "method", "low": "low", "high": "high"} */
SELECT * FROM shown_lengths;

/* {"chart": "P5-length-cells",
    "title": "Cells or blocks of boxes that a ray visits, by the length of the ray",
    "settings": "rays from near the origin; boxes along the rays, about half of the boxes hit; edges of 1 m or one ulp of the coordinates, whichever is larger; cells of 1 m, single precision",
    "x": "length log", "y": "cells log", "series": "method"} */
SELECT * FROM shown_lengths;

/* {"table": "times"} */
SELECT * FROM shown_times;

/* {"chart": "P5-missed-time", "title": "Missed boxes against the time per ray",
    "settings": "{slab}; medians of at least 60 frames", "mark": "point", "x": "time log",
    "y": "missed log0", "series": "method", "front": true} */
SELECT * FROM shown_times;

/* {"chart": "P5-nearest-time", "title": "Rays with a wrong nearest box against the time per ray",
    "settings": "{slab}; medians of at least 60 frames", "mark": "point", "x": "time log",
    "y": "wrong_nearest log0", "series": "method", "front": true} */
SELECT * FROM shown_times;

/* {"checks": "of methods that must find all"} */
WITH total AS (
    SELECT number, method, nearest_only, sum(hits) AS hits, sum(missed) AS missed,
           sum(rays_that_hit) AS rays_that_hit, sum(none_found) AS none_found,
           sum(wrong_nearest) AS wrong_nearest, sum(far_from_nearest) AS far_from_nearest
    FROM did JOIN methods USING (method) WHERE must_find_all GROUP BY number)
SELECT claim, holds, evidence FROM (
    SELECT number, 1 AS part, method || ' misses no box that a ray hits' AS claim,
           missed = 0 AND hits > 0 AS holds,
           thousands(missed) || ' of ' || thousands(hits) || ' hits missed' AS evidence
    FROM total WHERE NOT nearest_only
    UNION ALL
    SELECT number, 1, method || ' finds a box for every ray that hits a box',
           none_found = 0 AND rays_that_hit > 0,
           thousands(none_found) || ' of ' || thousands(rays_that_hit) || ' rays found no box'
    FROM total WHERE nearest_only
    UNION ALL
    SELECT number, 2,
           method || ' puts the nearest box first, except for rounding',
           far_from_nearest = 0 AND rays_that_hit > 0,
           thousands(far_from_nearest) || ' of ' || thousands(rays_that_hit)
           || ' rays with a wrong first box; others by rounding or false hits: '
           || thousands(wrong_nearest - far_from_nearest)
    FROM total)
ORDER BY number, part;

/* {"choices": "all boxes, the nearest box"} */
SELECT task, method, frame_ms, error, result, ours, low_ms FROM (
    SELECT grazed.*, 1 AS part, 'All boxes on ' || texts.rays || ': missed' AS task,
           ifnull(missed_percent, 0) AS error,
           'misses ' || number(ifnull(missed_percent, 0)) || ' % of hits' AS result
    FROM grazed, texts WHERE NOT nearest_only
    UNION ALL
    SELECT grazed.*, 2, 'The nearest box on ' || texts.rays || ': wrong', wrong_percent,
           'wrong box or no box on ' || number(wrong_percent) || ' % of rays'
    FROM grazed, texts)
ORDER BY number, part;

/* {"conclusions": "a sentence a method"} */
SELECT method || ': ' || ms(ns) || ' ns per ray. Grazing rays: '
       || iif(nearest_only, '', 'misses ' || thousands(grazed.missed) || ' of '
                                || thousands(grazed.hits) || ' hits, ')
       || thousands(falsely) || ' false hits, wrong nearest box on ' || thousands(wrong_nearest)
       || ' of ' || thousands(rays_that_hit) || ' rays'
       || iif(nearest_only, '', '. Rays of ' || thousands(length) || ' cells: misses '
                                || thousands(longest.missed) || ' of ' || thousands(longest.hits)
                                || ' hits')
       || '.'
FROM grazed JOIN longest USING (method) ORDER BY number;
)sql"
