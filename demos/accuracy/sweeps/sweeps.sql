R"sql(-- SPDX-License-Identifier: Zlib
--
-- P1. Measured are: plan, methods, motions, frames (a row for each method and frame, at a wall of a
-- thickness or of a motion in cells), bodies (each round in Bullet's world) and times (each frame).
-- Contacts are those that begin during a frame.

-- What a method did at the walls, at a ratio, and in the landscape.
CREATE TABLE at_walls AS
SELECT number, method, thickness, ratio, sum(contacts) AS contacts, sum(missed) AS missed,
       sum(invented) AS invented
FROM frames JOIN methods USING (method) WHERE thickness IS NOT NULL
GROUP BY number, ratio, thickness;

CREATE TABLE moved AS
SELECT methods.*, motions.rowid AS motion_number, motion,
       number(motion) || iif(motion = 1, ' cell a frame', ' cells a frame') AS motion_text,
       sum(movers) AS movers, sum(contacts) AS contacts, sum(missed) AS missed,
       1.0 * sum(missed) / max(sum(contacts), 1) AS missed_share, sum(invented) AS invented,
       sum(cells) AS cells, sum(tests) AS tests, max(time_error) AS time_error, ms, low, high
FROM frames JOIN methods USING (method) JOIN motions USING (motion) JOIN
     (SELECT method, motion, median(ms) AS ms, percentile(ms, 0.05) AS low,
             percentile(ms, 0.95) AS high FROM times GROUP BY method, motion) USING (method, motion)
GROUP BY motions.rowid, number;

-- And in all.
CREATE TABLE did AS
SELECT methods.*, count(*) AS frames, sum(contacts) AS contacts, sum(missed) AS missed,
       sum(invented) AS invented, sum(unlike) AS unlike, max(relative_time_error) AS time_error
FROM frames JOIN methods USING (method) GROUP BY number;

CREATE VIEW body_methods AS
SELECT 0 AS continuous, 'Bullet''s bodies, no CCD' AS method UNION ALL VALUES (1, 'Bullet''s bodies, CCD');

-- Lines of the chart of tunnelling. Those that lie on each other are drawn once, as that of the first.
CREATE TABLE lines AS
SELECT number, method, ratio, sum(contacts) - sum(missed) AS detected, sum(contacts) AS contacts
FROM at_walls GROUP BY number, ratio
UNION ALL
SELECT 1000 + continuous, method, ratio, sum(bodies) - sum(tunnelled), sum(bodies)
FROM bodies JOIN body_methods USING (continuous) GROUP BY continuous, ratio;

CREATE TABLE twins AS
SELECT number, method, min(number) OVER (PARTITION BY shape) AS first
FROM (SELECT number, method, group_concat(percent(detected, contacts)) AS shape
      FROM (SELECT * FROM lines ORDER BY number, ratio) GROUP BY number)
ORDER BY number;

CREATE VIEW texts AS
SELECT 'bullets of radius 5 mm touch a wall at a random moment of a frame (uniformly distributed); walls of '
       || (SELECT group_concat(number(thickness), ', ')
           FROM (SELECT DISTINCT thickness FROM at_walls ORDER BY thickness))
       || ' m, every second wall moves; bullets fly up to 7 degrees obliquely; truth in integers; bars: 95 % intervals; '
       || 'seed ' || seed
       || ifnull((SELECT group_concat(note, '')
                  FROM (SELECT '; on the line of ' || owner.method || ' also: '
                               || group_concat(twin.method, ', ') AS note
                        FROM (SELECT * FROM twins ORDER BY number) AS twin
                             JOIN twins AS owner ON twin.first = owner.number
                        WHERE twin.number <> owner.number GROUP BY owner.number)), '') AS walls,
       thousands(movers) || ' of ' || thousands(objects) || ' boxes fly in a new direction each frame: '
       || 'horizontally by the stated distance, and up or down by up to half of it; cells of 1 m; '
       || (SELECT group_concat(judged_frames, ', ') FROM motions) || ' frames checked, ' || timed_frames
       || ' timed, methods in random order; seed ' || seed AS landscape
FROM plan;

CREATE VIEW shown_moves AS
SELECT motion_text AS "motion: fast objects move by", method, moved.ms AS "frame_ms: frame [ms]",
       low AS "low_ms: 5th percentile [ms]", high AS "high_ms: 95th percentile [ms]",
       moved.ms / bullet.ms AS "ratio: frame [times Bullet's, united and tested]", contacts,
       missed AS "missed: missed contacts",
       100 * missed_share AS "missed_share: missed [%]",
       ifnull(100 * interval_low(missed, contacts), 0) AS "missed_low: at least [%]",
       ifnull(100 * interval_high(missed, contacts), 100) AS "missed_high: at most [%]",
       1.0 * invented / movers AS "false: false pairs per object",
       iif(cells > 0, 1.0 * cells / movers, NULL) AS "cells: cells or boxes searched per object",
       iif(tests > 0, 1.0 * tests / movers, NULL) AS "tests: tests per object",
       iif(tells_time AND contacts > 0, time_error, NULL)
           AS "time_error: largest error of times of contact [frames]"
FROM moved LEFT JOIN (SELECT motion_number AS at, min(number), ms FROM moved
                      WHERE origin = 'bullet' AND exact GROUP BY at) AS bullet ON at = motion_number
ORDER BY motion_number, number;

/* {"chart": "P1-tunnelling",
    "title": "Detected contacts of bullets with walls, by the distance that a bullet flies in a frame",
    "settings": "{walls}", "x": "ratio log", "y": "detected", "series": "method", "low": "low",
    "high": "high", "theory": "theory"} */
SELECT ratio AS "ratio: distance v dt [wall thickness T + bullet diameter 2r]", method,
       percent(detected, contacts) AS "detected: contacts detected, bodies stopped [%]",
       100 * interval_low(detected, contacts) AS "low: at least [%]",
       100 * interval_high(detected, contacts) AS "high: at most, 95 % sure [%]",
       100 * min(1.0, 1.0 / ratio) AS "theory: theory for discrete methods: min(1, (T + 2r) / (v dt)) [%]", contacts
FROM lines JOIN twins USING (number, method) WHERE number = first ORDER BY number, ratio;

/* {"chart": "{:name}", "title": "Contacts missed against the time of a frame, at {:motion_text}",
    "settings": "{landscape}", "mark": "point", "x": "frame_ms log", "y": "missed_share log0",
    "series": "method", "low": "missed_low", "high": "missed_high", "front": true,
    "each": "SELECT DISTINCT motion_text, iif(motion_number = (SELECT max(rowid) FROM motions), 'P1-pareto', 'P1-pareto-' || number(motion) || '-cells') AS name FROM moved"} */
SELECT * FROM shown_moves WHERE "motion: fast objects move by" = :motion_text;

/* {"chart": "P1-false",
    "title": "False pairs of each fast object, which the narrow phase must test",
    "settings": "{landscape}", "mark": "point", "x": "method names", "y": "false log0",
    "series": "motion"} */
SELECT * FROM shown_moves;

/* {"settings": "scenes, methods"} */
SELECT 'P1-tunnelling: ' || walls || '.' FROM texts
UNION ALL
SELECT 'P1-false: ' || landscape || '.' FROM texts
UNION ALL VALUES
('Contacts that began in an earlier frame do not count, for any method. Discrete methods know only the boxes at the end of the frame.'),
('In the paper''s methods, two objects that share a cell are a pair if the boxes around their paths overlap. The paper''s grid stores resting objects once, has a given cell size, and keeps no pairs between frames; the other methods keep pairs.'),
('The false pairs of btDbvtBroadphase, united, include pairs that it keeps from earlier frames.'),
('Bullet''s bodies are spheres without gravity; with CCD, their motion threshold and swept sphere radius are their radius. A body counts as stopped if it is not behind the wall at the end.');

/* {"table": "bullets at walls"} */
SELECT method AS "method: bullets at walls: method", contacts, missed AS "missed: missed contacts",
       "false: false pairs" FROM (
    SELECT number, method, sum(contacts) AS contacts, sum(missed) AS missed,
           sum(invented) AS "false: false pairs"
    FROM at_walls GROUP BY number
    UNION ALL
    SELECT 1000 + continuous, method, sum(bodies), sum(tunnelled), NULL
    FROM bodies JOIN body_methods USING (continuous) GROUP BY continuous)
ORDER BY number;

/* {"table": "fast movers"} */
SELECT "motion: fast objects move by", method, "frame_ms: frame [ms]",
       "ratio: frame [times Bullet's, united and tested]", contacts, "missed_share: missed [%]",
       "false: false pairs per object", "cells: cells or boxes searched per object",
       "tests: tests per object", "time_error: largest error of times of contact [frames]"
FROM shown_moves;

/* {"checks": "the line of theory; of intervals that hold the truth in 95 of 100 cases, 15 of 100 fail next to never"} */
SELECT 'Discrete detection lies on the line of theory, min(1, (T + 2r) / (v dt)): the line is in the 95 % intervals of at least 85 % of the points',
       EXISTS (SELECT * FROM at_walls) AND (count(*) = 0 OR min(within >= 0.85 * points)),
       ifnull(group_concat(method || ': ' || thousands(within) || ' of ' || thousands(points)
                           || ' points', '; '), '')
FROM (SELECT method, count(*) AS points,
             sum(min(1.0, 1.0 / ratio) BETWEEN interval_low(contacts - missed, contacts)
                                         AND interval_high(contacts - missed, contacts)) AS within
      FROM at_walls JOIN methods USING (number, method) WHERE discrete GROUP BY number ORDER BY number);

/* {"checks": "promises"} */
SELECT 'Methods that promise to find every contact miss none', count(*) = 0 OR min(missed = 0),
       ifnull(group_concat(method || ': ' || thousands(missed) || ' of ' || thousands(contacts), '; '), '')
FROM (SELECT * FROM did WHERE misses_nothing ORDER BY number)
UNION ALL
SELECT 'Methods that promise to list only contacts list no other pairs', count(*) = 0 OR min(invented = 0),
       ifnull(group_concat(method || ': ' || thousands(invented), '; '), '')
FROM (SELECT * FROM did WHERE invents_nothing ORDER BY number)
UNION ALL
SELECT 'Exact methods list the same pairs, frame by frame', count(*) = 0 OR min(unlike = 0),
       ifnull(group_concat(method || ': '
                           || iif(is_first, 'the reference for the others',
                                  thousands(unlike) || ' of ' || thousands(frames) || ' frames differ'),
                           '; '), '')
FROM (SELECT *, number = min(number) OVER () AS is_first FROM did WHERE compared ORDER BY number)
UNION ALL  -- rounded to double, a time is off by a few parts in 2^53
SELECT 'Times of contact are exact except for rounding to double: the relative error is at most 1e-15',
       count(*) = 0 OR min(time_error <= 1e-15),
       ifnull(group_concat(method || ': ' || number(time_error) || ' at worst in ' || thousands(contacts) || ' contacts',
                           '; '), '')
FROM (SELECT * FROM did WHERE tells_time ORDER BY number);

/* {"choices": "what lists false pairs leaves their test to others: it does not compete with what tests them"} */
SELECT 'Fast movers: ' || thousands(plan.movers) || ' of ' || thousands(objects) || ' at ' || motion_text,
       method, ms, missed_share,
       iif(missed = 0, 'misses none of ' || thousands(contacts) || ' contacts',
           'misses ' || number(100 * missed_share) || ' % of contacts'), origin = 'ours', low
FROM moved, plan WHERE invents_nothing ORDER BY motion_number, number;

/* {"conclusions": "who misses bullets, and bodies"} */
SELECT 'Bullets at walls: '
       || group_concat(method || ' '
                       || iif(missed = 0, 'misses none of ' || thousands(contacts) || ' contacts',
                              'misses ' || number(percent(missed, contacts)) || ' % of contacts'), '; ')
       || '.'
FROM (SELECT method, sum(contacts) AS contacts, sum(missed) AS missed
      FROM at_walls GROUP BY number ORDER BY number)
UNION ALL
SELECT 'Bodies in Bullet''s world that ended behind the wall'
       || group_concat(iif(continuous, '; with ', ': without ') || 'continuous collision detection '
                       || thousands(tunnelled) || ' of ' || thousands(bodies), '')
       || '.'
FROM (SELECT continuous, sum(tunnelled) AS tunnelled, sum(bodies) AS bodies
      FROM bodies GROUP BY continuous ORDER BY continuous);

/* {"conclusions": "the fastest of those that see every contact and list nothing else"} */
WITH fastest AS (
    SELECT motion_number, origin, method || ' in ' || ms(min(moved.ms)) || ' ms' AS sentence
    FROM moved WHERE missed + invented = 0 GROUP BY motion_number, origin)
SELECT 'The fastest methods without errors at ' || motion_text || ': hashphase: '
       || ifnull((SELECT sentence FROM fastest WHERE origin = 'ours'
                  AND fastest.motion_number = moved.motion_number), 'none')
       || '; the paper''s grid: '
       || ifnull((SELECT sentence FROM fastest WHERE origin = 'paper'
                  AND fastest.motion_number = moved.motion_number), 'none')
       || '; Bullet: '
       || ifnull((SELECT sentence FROM fastest WHERE origin = 'bullet'
                  AND fastest.motion_number = moved.motion_number), 'none')
       || '.'
FROM moved GROUP BY motion_number;
)sql"
