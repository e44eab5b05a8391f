R"sql(-- SPDX-License-Identifier: Zlib
--
-- P10. Beside what pairs.sql reads: plan; trials have a motion.

CREATE VIEW texts AS
SELECT thousands(objects) || ' boxes with edges of 0.5-1.5 m; each overlaps about two others. Moving boxes move '
       || 'by up to the stated distance per axis and frame. A frame: the calls of setAabb, and finding all '
       || 'pairs, including the pair cache (the paper''s grid keeps no pair cache). Times: medians of ' || rounds
       || ' means, each of ' || frames_together || ' frames in a row.' AS scene
FROM plan;

-- A row for each of `did`, under the same rowid.
CREATE TABLE shown AS
SELECT method AS policy, motion AS "motion: how many boxes move, and how far",
       100 * share AS "moving_percent: moving boxes [%]", ns AS "ns: time [ns/object]",
       speed AS "speed: times as fast as btDbvtBroadphase", true_pairs AS "true_pairs: true pairs checked",
       missed AS "missed: missed pairs", missed_share AS "missed_share: missed pairs [share of the true pairs]",
       low AS "missed_low: at least [share]", high AS "missed_high: at most, 95 % sure [share]",
       extra AS "false: false pairs",
       extra_share AS "false_share: false pairs per true pair"
FROM results;

-- The motions that differ from the first in their share only.
CREATE VIEW alike AS SELECT trial, share FROM trials WHERE step = (SELECT step FROM trials);

/* {"settings": "scene, truth, words"} */
SELECT scene FROM texts
UNION ALL VALUES
('Truth: in every checked frame, a sweep along one axis finds the true pairs of the boxes of this frame. Brute force checks the sweep.'),
('Moved only: setAabb for all boxes. An unchanged box costs one comparison. A box that has not moved for eight frames rests in a table that no update visits.');

-- Where nothing moves, there is nothing to miss, whatever one is not told.
/* {"checks": "stillness"} */
SELECT 'No policy misses a pair if no box moves', total(missed) = 0,
       thousands(total(missed)) || ' of ' || thousands(total(true_pairs)) || ' missed'
FROM did WHERE share = 0;

/* {"chart": "P10-break-even",
    "title": "Time against the share of moving boxes: policies break even where their lines cross",
    "settings": "{scene}", "x": "moving_percent", "y": "ns log", "series": "policy"} */
SELECT * FROM shown WHERE rowid IN (SELECT rowid FROM did WHERE trial IN (SELECT trial FROM alike));

/* {"chart": "P10-missed", "title": "Missed pairs against time", "settings": "{scene}",
    "mark": "point", "x": "ns log", "y": "missed_share log0", "series": "policy", "low": "missed_low",
    "high": "missed_high", "label": "motion", "front": true} */
SELECT * FROM shown;

/* {"chart": "P10-false", "title": "False pairs against time: work for the narrow phase",
    "settings": "{scene}", "mark": "point", "x": "ns log", "y": "false_share log0", "series": "policy",
    "label": "motion", "front": true} */
SELECT * FROM shown;

/* {"table": "all move", "each": "SELECT trial FROM trials WHERE share = 1"} */
SELECT * FROM shown WHERE rowid IN (SELECT rowid FROM did WHERE trial = :trial);

/* {"chart": "P10-missed-by-policy-{number(100 * :step)}-cm", "title": "Missed pairs by policy: {:motion}",
    "settings": "{scene}", "mark": "bar", "x": "policy names", "y": "missed_share", "series": "policy",
    "low": "missed_low", "high": "missed_high", "each": "SELECT * FROM trials WHERE share = 1"} */
SELECT * FROM shown WHERE rowid IN (SELECT rowid FROM did WHERE trial = :trial);

/* {"chart": "P10-false-by-policy-{number(100 * :step)}-cm", "title": "False pairs by policy: {:motion}",
    "settings": "{scene}", "mark": "bar", "x": "policy names", "y": "false_share", "series": "policy",
    "each": "SELECT * FROM trials WHERE share = 1"} */
SELECT * FROM shown WHERE rowid IN (SELECT rowid FROM did WHERE trial = :trial);

-- What lists false pairs for the sake of speed leaves their test to others: it does not compete with the
-- same way that tests them itself.
/* {"choices": "by missed pairs"} */
SELECT 'Pairs of ' || thousands(objects) || ' boxes, ' || motion, method, ms, missed_share, result,
       origin = 'ours', ms_low
FROM did WHERE is_task AND NOT (origin = 'ours' AND complete AND NOT exact);

/* {"conclusions": "where policies break even",
    "each": "SELECT column1 AS other FROM (VALUES ('all filed again'), ('btDbvtBroadphase'))"} */
SELECT '''moved only'' against ''' || :other || ''', by the share of moving boxes: faster at '
       || coalesce(group_concat(iif(ratio >= 1, text, NULL), ', '), 'no share')
       || '; slower at '
       || coalesce(group_concat(iif(ratio >= 1, NULL, text), ', '), 'no share') || '.'
FROM (SELECT ratio, number(100 * share) || ' % (' || fixed(ratio, iif(ratio < 10, 2, 0)) || 'x)' AS text
      FROM (SELECT trial, other.ns / own.ns AS ratio FROM did AS own JOIN did AS other USING (trial)
            WHERE own.method = 'moved only' AND other.method = :other)
           JOIN alike USING (trial) ORDER BY trial)
GROUP BY :other;

/* {"conclusions": "the fastest"} */
SELECT 'The fastest exact policy, by motion: ' || group_concat(text, '; ') || '.'
FROM (SELECT motion || ': ''' || method || ''' (' || fixed(min(ns), 1) || ' ns per object)' AS text
      FROM did WHERE exact GROUP BY trial ORDER BY trial);

/* {"conclusions": "errors", "each": "SELECT * FROM trials WHERE share = 1"} */
SELECT 'If ' || :motion || ': ' || group_concat('''' || method || ''' ' || result, '; ') || '.'
FROM did WHERE trial = :trial AND NOT exact;
)sql"
