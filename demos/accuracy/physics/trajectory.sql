R"sql(-- SPDX-License-Identifier: Zlib
--
-- P8. Measured are: plan, methods (broadphases), runs (scenes with the lists in an order), states (a row for
-- each run, method and step) and times (the same).

CREATE VIEW texts AS
SELECT thousands(steps) || ' steps of 1/60 s, 10 solver iterations, sleeping on, single precision, seed '
       || seed AS scene, (SELECT count(DISTINCT scene) FROM runs) AS scenes, steps
FROM plan;

-- What a broadphase did in a run; `differs` is the first step after which a bit differs from brute force.
CREATE TABLE did AS
WITH medians AS (SELECT list, scene, method, median(ms) AS ms, percentile(ms, 0.05) AS low,
                        percentile(ms, 0.95) AS high FROM times GROUP BY list, scene, method),
     truth AS (SELECT list, scene, step, state AS truth FROM states WHERE method = 'btSimpleBroadphase'),
     differences AS (SELECT list, scene, method, min(step) AS differs
                     FROM states JOIN truth USING (list, scene, step) WHERE state <> truth
                     GROUP BY list, scene, method),
     sums AS (SELECT list, scene, method, sum(asleep) AS asleep, max(step), pairs  -- those of the last step
              FROM states GROUP BY list, scene, method)
SELECT runs.rowid AS run, methods.rowid AS number, *
FROM runs JOIN sums USING (list, scene) JOIN methods USING (method) JOIN medians USING (list, scene, method)
     LEFT JOIN differences USING (list, scene, method)
ORDER BY run, number;

-- In how many scenes bodies move as under brute force.
CREATE TABLE sameness AS
SELECT min(run) AS run, list, number, method, ours, exact, count(*) - count(differs) AS same,
       (count(*) - count(differs)) || ' of ' || count(*) AS same_text, avg(ms) AS ms, avg(low) AS low
FROM did GROUP BY list, method ORDER BY min(run), number;
CREATE VIEW sentences AS
SELECT list, group_concat(method || ' in ' || same_text, ', ') AS sentence
FROM (SELECT * FROM sameness WHERE method <> 'btSimpleBroadphase' ORDER BY run, number) GROUP BY list;

/* {"settings": "scene, truth, words"} */
SELECT scene || '.' FROM texts
UNION ALL VALUES
('Truth: btSimpleBroadphase, which compares every pair of boxes. Positions, velocities and activation states of all bodies are compared after every step, bit by bit.'),
('Canonical order: pairs are sorted by the indices of the bodies, and contact manifolds by age. So only the set of pairs can affect the motion.'),
('m_deterministicOverlappingPairs sorts contacts by unique ids. If bodies are removed and added again (churn), btSimpleBroadphase and bt32BitAxisSweep3 reuse these ids; the other broadphases do not.'),
('lattice: spheres that fall into an open box; bouncing: balls that bounce endlessly; compounds: dumbbells and crosses that fall into a heap; churn: a pile from which bodies are removed and dropped again. The other scenes are scenes of `hashphase compare`.');

CREATE VIEW words AS
SELECT *, iif(differs IS NULL, 'yes', 'until step ' || differs) AS word FROM did;

/* {"table": "whose bodies move as under brute force, scene by scene"} */
SELECT list AS "order: order of lists", scene, objects,
       max(iif(method = 'hashphase', word, NULL)) AS "hashphase: same bits with hashphase",
       max(iif(method = 'btDbvtBroadphase', word, NULL))
       AS "btDbvtBroadphase: same bits with btDbvtBroadphase",
       max(iif(method = 'btDbvtBroadphase, exact boxes', word, NULL))
       AS "btDbvtBroadphase, exact boxes: same bits with btDbvtBroadphase, exact boxes",
       max(iif(method = 'bt32BitAxisSweep3', word, NULL))
       AS "bt32BitAxisSweep3: same bits with bt32BitAxisSweep3"
FROM words GROUP BY run ORDER BY run;

CREATE VIEW step_times AS
SELECT did.scene, did.objects, did.method, did.ms AS "step_ms: step [ms]",
       did.low AS "low_ms: 5th percentile [ms]", did.high AS "high_ms: 95th percentile [ms]",
       1000 / 60.0 / did.ms AS "real_time_factor: speed [times real time]",
       dbvt.ms / did.ms AS "ratio_to_dbvt: times as fast as btDbvtBroadphase",
       did.pairs AS "pairs: pairs at the end", 1.0 * did.asleep / steps AS "asleep: bodies asleep on average"
FROM did JOIN did AS dbvt USING (run), plan
WHERE did.list = 'as shipped' AND dbvt.method = 'btDbvtBroadphase' ORDER BY run, did.number;

/* {"table": "what a step costs, lists as shipped"} */
SELECT * FROM step_times;

/* {"chart": "P8-same-motion",
    "title": "In how many scenes is the motion of all bodies bit-identical to brute force?",
    "settings": "{scene}; {scenes} scenes", "mark": "cell", "x": "method names", "y": "order names",
    "shade": "same"} */
SELECT method AS "method: broadphase", list AS "order: order of lists",
       same AS "same: scenes with the same motion"
FROM sameness;

/* {"chart": "P8-step-time", "title": "Time of a whole step with each broadphase",
    "settings": "{scene}; lists as shipped; bars: 5th to 95th percentile of the steps", "mark": "point",
    "x": "scene names", "y": "step_ms log", "series": "method", "low": "low_ms", "high": "high_ms"} */
SELECT * FROM step_times;

/* {"checks": "exact broadphases"} */
SELECT method || ' and btSimpleBroadphase give bit-identical motion of all bodies if pairs and contacts are '
       || 'listed in canonical order', same = scenes, same_text || ' scenes, ' || steps || ' steps each'
FROM sameness, texts WHERE list = 'canonical' AND exact AND method <> 'btSimpleBroadphase' ORDER BY number;

/* {"choices": "by scenes with another motion"} */
SELECT 'A step of a Bullet world with the same motion as under brute force (mean of ' || scenes || ' scenes)',
       method || ', lists ' || list, ms, 1 - 1.0 * same / scenes,
       'the same motion in ' || same_text || ' scenes', ours, low
FROM sameness, texts ORDER BY run, number;

-- Why the tree differs from brute force, as far as the runs tell.
CREATE VIEW dbvt AS
SELECT 100.0 * sum(dbvt.pairs - truth.pairs) / max(sum(truth.pairs), 1) AS extra_percent,
       100.0 * sum(dbvt.asleep) / sum(truth.asleep) AS asleep_percent  -- null where none sleeps
FROM did AS dbvt JOIN did AS truth USING (run, list)
WHERE list = 'canonical' AND dbvt.method = 'btDbvtBroadphase' AND truth.method = 'btSimpleBroadphase';

/* {"conclusions": "the same motion"} */
SELECT 'Lists in canonical order, the same motion as under btSimpleBroadphase: ' || sentence || ' scenes.'
FROM sentences WHERE list = 'canonical'
UNION ALL
SELECT 'btDbvtBroadphase gives the same motion as brute force in ' || canonical.same_text
       || ' scenes in canonical order, and in ' || flagged.same_text || ' with m_deterministicOverlappingPairs. '
       || 'At the end, it lists ' || fixed(extra_percent, 1) || ' % more pairs than overlap'
       || iif(asleep_percent IS NULL, '', ', and bodies slept for ' || fixed(asleep_percent, 1)
              || ' % of the time that they sleep under brute force')
       || '. The extra pairs have no contacts, but they change the order in which Bullet solves contacts, and '
       || 'which bodies may sleep'
       || coalesce('. The same tree with exact boxes gives the same motion in '
                   || (SELECT same_text FROM sameness
                       WHERE list = 'canonical' AND method = 'btDbvtBroadphase, exact boxes') || ' scenes', '') || '.'
FROM dbvt, sameness AS canonical JOIN sameness AS flagged USING (method)
WHERE method = 'btDbvtBroadphase' AND canonical.list = 'canonical'
      AND flagged.list = 'm_deterministicOverlappingPairs'
UNION ALL
SELECT 'With only m_deterministicOverlappingPairs: ' || sentence || ' scenes.'
FROM sentences WHERE list = 'm_deterministicOverlappingPairs'
UNION ALL
SELECT 'Lists as shipped: ' || sentence || ' scenes. Bullet''s own broadphases differ from each other too: '
       || 'Bullet''s results depend on the order of pairs.'
FROM sentences WHERE list = 'as shipped';

/* {"conclusions": "time"} */
SELECT 'A whole step with hashphase is ' || fixed(min(ratio), 2) || ' to ' || fixed(max(ratio), 2)
       || ' times as fast as with btDbvtBroadphase, ' || fixed(median(ratio), 2)
       || ' times in the median scene: with few bodies, most of a step is narrow phase and solver.'
FROM (SELECT "ratio_to_dbvt: times as fast as btDbvtBroadphase" AS ratio
      FROM step_times WHERE method = 'hashphase')
GROUP BY 1 = 1;
)sql"
