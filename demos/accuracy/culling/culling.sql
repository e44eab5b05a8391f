R"sql(-- SPDX-License-Identifier: Zlib
--
-- P4. Measured are: plan, methods, looks (a row for each method and view) and times (each flight).

CREATE VIEW texts AS
SELECT thousands(objects) || ' boxes of 1 to 3 m on flat ground of 1000 m x 1000 m; camera 120 m above '
       || 'it, far plane 400 m; unless varied: field of view 60 degrees, pitch -45, yaw 20, objects up '
       || 'to 10 m, cells of 10 m; seed ' || seed AS scene
FROM plan;

-- What a method did in a setting.
CREATE TABLE did AS
SELECT looks.scene, looks.setting, looks.cell, looks.method, sum(visible) AS visible,
       sum(lost) AS lost, sum(in_vain) AS in_vain, avg(cells) AS cells, avg(boxes) AS boxes,
       percent(sum(lost), sum(visible)) AS lost_percent,
       percent(sum(in_vain), sum(visible)) AS in_vain_percent
FROM looks GROUP BY looks.scene, looks.setting, looks.method ORDER BY min(looks.rowid);

-- What it did in all settings; worst_setting is that of the greatest loss.
CREATE TABLE did_in_all AS
SELECT total.* FROM (
    SELECT method, scene, sum(visible) AS visible, sum(lost) AS lost, sum(in_vain) AS in_vain,
           max(lost_percent) AS worst, setting AS worst_setting
    FROM did GROUP BY scene, method) AS total JOIN methods USING (method)
ORDER BY scene, number;

-- With its time, in microseconds a look, where it was timed.
CREATE TABLE timed AS
SELECT did.*, methods.*, did_in_all.lost AS lost_in_all, worst,
       iif(takes_cells, did.method || ', ' || number(did.cell) || ' m cells', did.method) AS name,
       iif(takes_cells, number(did.cell) || ' m', '') AS label,
       1000 * median(ms) AS us, 1000 * percentile(ms, 0.05) AS low,
       1000 * percentile(ms, 0.95) AS high
FROM did JOIN methods USING (method) JOIN did_in_all USING (scene, method)
     JOIN times USING (setting, method)
WHERE did.scene = 'ground' GROUP BY did.setting, did.method ORDER BY did.rowid;

CREATE TABLE bullet AS SELECT * FROM timed WHERE method = 'btDbvt::collideKDOP';

/* {"settings": "scene, truth, times"} */
SELECT scene || '.' FROM texts
UNION ALL VALUES
('An object is visible if its box shares a point with the frustum. The truth clips boxes by the planes of the frustum in long double.'),
('Objects stand still, so the times exclude updates; Bullet''s trees are optimised.'),
('In the checks of objects that only touch the view, these objects are above the ground: footprints at ground height do not cover them.'),
('A flight is 8 queries of a camera that moves at 6 m/s and turns by 12 degrees a second, at 60 queries a second. The time per query is an eighth of the time of a flight.');

/* {"chart": "P4-lost", "title": "Lost objects: visible, but not drawn (correct: 0)",
    "settings": "{scene}", "mark": "point", "x": "setting names", "y": "lost", "series": "method",
    "low": "low", "high": "high"} */
SELECT setting, method, lost_percent AS "lost: visible objects lost [%]",
       100 * interval_low(lost, max(visible, 1)) AS "low: at least [%]",
       100 * interval_high(lost, max(visible, 1)) AS "high: at most, 95 % sure [%]",
       in_vain_percent AS "in_vain: drawn needlessly [% of visible]",
       cells AS "cells: cells a frame", boxes AS "boxes: boxes tested a frame"
FROM did WHERE scene = 'ground';

/* {"chart": "P4-overdraw", "title": "Invisible objects that are drawn",
    "settings": "{scene}", "mark": "point", "x": "setting names", "y": "in_vain", "series": "method"} */
SELECT setting, method, lost_percent AS "lost: visible objects lost [%]",
       100 * interval_low(lost, max(visible, 1)) AS "low: at least [%]",
       100 * interval_high(lost, max(visible, 1)) AS "high: at most, 95 % sure [%]",
       in_vain_percent AS "in_vain: drawn needlessly [% of visible]",
       cells AS "cells: cells a frame", boxes AS "boxes: boxes tested a frame"
FROM did WHERE scene = 'ground';

/* {"chart": "P4-lost-time", "title": "Visible objects lost against the time per query",
    "settings": "{scene}; medians of at least 60 flights of 8 queries", "mark": "point", "x": "time log",
    "y": "error log0", "series": "method", "label": "cell", "front": true} */
SELECT method, label AS "cell: cells", us AS "time: time per query [us]",
       lost_percent AS "error: visible objects lost [%]"
FROM timed;

/* {"chart": "P4-overdraw-time",
    "title": "Objects drawn needlessly against the time per query: methods that lose none",
    "settings": "{scene}; medians of at least 60 flights of 8 queries", "mark": "point", "x": "time log",
    "y": "error log0", "series": "method", "label": "cell", "front": true} */
SELECT method, label AS "cell: cells", us AS "time: time per query [us]",
       in_vain_percent AS "error: drawn needlessly [% of visible]"
FROM timed WHERE lost_in_all = 0;

/* {"table": "times"} */
SELECT timed.name AS method, timed.us AS "time: time per query [us]", timed.low AS "low: 5th percentile [us]",
       timed.high AS "high: 95th percentile [us]", timed.us / bullet.us AS "ratio: time per query [times Bullet's]",
       timed.lost_percent AS "lost: visible objects lost [%]",
       timed.in_vain_percent AS "in_vain: drawn needlessly [%]",
       iif(timed.method = bullet.method, NULL, timed.cells) AS "cells: cells or rows of cells",
       iif(timed.method = bullet.method, NULL, timed.boxes) AS "boxes: boxes tested"
FROM timed LEFT JOIN bullet;

/* {"checks": "what each method promises"} */
SELECT claim, holds, evidence FROM (
    SELECT number, 1 AS part, method || ' draws every visible object' AS claim,
           lost = 0 AND visible > 0 AS holds,
           thousands(lost) || ' lost of ' || thousands(visible) || ' visible' AS evidence
    FROM methods JOIN did_in_all USING (method) WHERE must_see_all AND scene = 'ground'
    UNION ALL
    SELECT number, 2, method || ' draws objects that only touch the view', lost = 0 AND visible > 0,
           thousands(lost) || ' lost of ' || thousands(visible) || ' visible'
    FROM methods JOIN did_in_all USING (method) WHERE must_see_all AND scene = 'touching'
    UNION ALL  -- by rounding one in 10,000
    SELECT number, 3, method || ' draws no invisible object, except by rounding', in_vain <= visible / 10000,
           thousands(in_vain) || ' drawn needlessly, ' || thousands(visible) || ' visible'
    FROM methods JOIN did_in_all USING (method) WHERE must_be_exact AND scene = 'ground')
ORDER BY number, part;

/* {"choices": "by what is lost, and by what is drawn needlessly"} */
SELECT 'Culling, ' || thousands(objects) || ' objects: visible objects lost, at worst', name, us / 1000,
       worst,
       iif(lost_in_all = 0, 'loses nothing', 'loses up to ' || number(worst) || ' % of the visible objects')
       || ', draws ' || number(in_vain_percent) || ' % needlessly', ours, low / 1000
FROM timed, plan
UNION ALL
SELECT 'Culling, ' || thousands(objects) || ' objects: drawn needlessly, none lost', name, us / 1000,
       in_vain_percent, 'draws ' || number(in_vain_percent) || ' % needlessly', ours, low / 1000
FROM timed, plan WHERE lost_in_all = 0;

/* {"conclusions": "losses"} */
SELECT method || ' loses up to ' || number(worst) || ' % of the visible objects (' || worst_setting || ').'
FROM did_in_all WHERE scene = 'ground' AND lost > 0;

/* {"conclusions": "losses at the sides"} */
SELECT method || ' loses ' || number(lost_percent) || ' % of ' || thousands(visible)
       || ' objects that touch the sides of the view within single precision.'
FROM did WHERE scene = 'touching' AND lost > 0;

/* {"conclusions": "times"} */
SELECT timed.name || ': a query takes ' || ms(timed.us) || ' us, ' || bullet.method || ' '
       || ms(bullet.us) || ' us; drawn needlessly: ' || number(timed.in_vain_percent) || ' % and '
       || number(bullet.in_vain_percent) || ' %.'
FROM timed, bullet WHERE timed.must_see_all AND NOT timed.takes_cells;
)sql"
