R"sql(-- SPDX-License-Identifier: Zlib
--
-- P7. Measured are: contestants, measures (of tasks), points (a task with one setting of the engine); errors
-- (a row for each point, contestant, measure and look), states (each point, contestant and look), times
-- (each point, contestant and frame).

CREATE VIEW texts AS
SELECT 'Bullet in single precision; two simulated seconds, compared 30 times a second; times are per simulated '
       || 'second (1,000 ms: real time); lower left is better' AS scene,
       (SELECT method FROM contestants) AS first_method;

CREATE TABLE settings AS
SELECT *, '1/' || per_second || ' s' AS step,
       '1/' || per_second || ' s, ' || iterations || ' iterations'
       || iif(keeps_energy, ', contacts that keep energy', '') AS setting,
       way LIKE 'smaller steps, %' AS by_steps
FROM points;

-- Root mean squares. Where speed is advanced before place, a free fall (of 10 m/s^2) goes wrong by half a
-- step's length at the speed gained.
CREATE TABLE did AS
WITH roots AS (SELECT point, contestant, measure, sqrt(avg(squared)) AS error,
                      sqrt(avg(seconds * seconds)) AS seconds
               FROM errors GROUP BY point, contestant, measure),
     medians AS (SELECT point, contestant, median(ms) AS ms, percentile(ms, 0.05) AS low,
                        percentile(ms, 0.95) AS high  -- of a simulated second
                 FROM times GROUP BY point, contestant)
SELECT *, 1000 * 10 * seconds / per_second / 2 AS fall_error,
       iif(unit = '', number(100 * error) || ' %', number(error) || ' ' || unit) AS error_text
FROM settings JOIN medians USING (point) JOIN contestants USING (contestant)
     JOIN roots USING (point, contestant) JOIN measures USING (task, measure)
ORDER BY point, measure, contestant;

-- Whether all broadphases with canonical lists passed through the same states.
CREATE TABLE sameness AS
SELECT point, max(different) <= 1 AS same
FROM (SELECT point, count(DISTINCT iif(canonical, state, NULL)) AS different
      FROM states JOIN contestants USING (contestant) GROUP BY point, look)
GROUP BY point;

/* {"settings": "scene, truth, words"} */
SELECT scene || '.' FROM texts
UNION ALL VALUES
('After SimBenchmark (Kang, Hwangbo and others). Truth: the laws of motion in double precision, and no overlap. The errors include the error of Bullet''s steps against continuous motion.'),
('Canonical order: pairs are sorted by the indices of the bodies, contacts by age and with m_deterministicOverlappingPairs. No body sleeps. Restitution applies at any speed.'),
('Contacts that keep energy: setContactProcessingThreshold(0), so that only touching bodies are in contact, and m_splitImpulsePenetrationThreshold above 0, so that overlap is undone without adding speed.');

/* {"table": "all"} */
SELECT task_name AS task, name AS "error: error, root mean square",
       step AS "step_s: step", iterations, iif(keeps_energy, 'keep energy', 'as shipped') AS contacts,
       iif(same, 'yes', 'no') AS "same: same states in canonical order",
       max(iif(contestant = 0, error_text, NULL))
       AS "hashphase, lists in canonical order error: hashphase, lists in canonical order: error",
       max(iif(contestant = 0, ms, NULL)) AS "hashphase, lists in canonical order ms: a simulated second [ms]",
       max(iif(contestant = 1, error_text, NULL))
       AS "btDbvtBroadphase, lists in canonical order error: btDbvtBroadphase, lists in canonical order: error",
       max(iif(contestant = 1, ms, NULL))
       AS "btDbvtBroadphase, lists in canonical order ms: a simulated second [ms]",
       max(iif(contestant = 2, error_text, NULL)) AS "hashphase error: hashphase: error",
       max(iif(contestant = 2, ms, NULL)) AS "hashphase ms: a simulated second [ms]",
       max(iif(contestant = 3, error_text, NULL)) AS "btDbvtBroadphase error: btDbvtBroadphase: error",
       max(iif(contestant = 3, ms, NULL)) AS "btDbvtBroadphase ms: a simulated second [ms]"
FROM did JOIN sameness USING (point) GROUP BY point, measure ORDER BY point, measure;

-- Of each task a chart for each measure, then one of all ways, and one of theory.
CREATE VIEW shown AS
SELECT *, title || ', root mean square' || iif(unit = '', ' [share]', ' [' || unit || ']') AS axis, column1 AS kind
FROM measures, (VALUES (1), (2), (3))
WHERE kind = 1 OR measure = 0 AND (kind = 2 OR task_name = 'fall') ORDER BY task, kind, measure;

/* {"chart": "P7-{:task_name}-{:name}", "title": "{:task_title}: {:title}",
    "settings": "10 iterations a step, one point for each step length; {scene}", "x": "second_ms log",
    "y": "error log0", "series": "method", "label": "step_s", "front": true,
    "each": "SELECT * FROM shown", "when": "{:kind = 1}"} */
SELECT method, step AS "step_s: step", ms AS "second_ms: time of a simulated second [ms]",
       low AS "low_ms: 5th percentile [ms]", high AS "high_ms: 95th percentile [ms]",
       1000.0 / ms AS "real_time_factor: speed [times real time]", error AS "error: {:axis}"
FROM did WHERE task = :task AND measure = :measure AND by_steps AND NOT keeps_energy
ORDER BY contestant, point;

/* {"chart": "P7-ways-{:task_name}", "title": "{:task_title}: what increases accuracy?",
    "settings": "{first_method}; {scene}", "x": "second_ms log", "y": "error log0", "series": "way",
    "label": "setting", "front": true, "each": "SELECT * FROM shown", "when": "{:kind = 2}"} */
SELECT way, setting, ms AS "second_ms: time of a simulated second [ms]", error AS "error: {:axis}"
FROM did WHERE task = :task AND measure = 0 AND contestant = 0 ORDER BY point;

/* {"chart": "P7-fall-theory",
    "title": "Error of free fall; theory: the speed gained, times half a step", "settings": "{scene}",
    "x": "step_ms log", "y": "error log", "series": "method", "theory": "theory",
    "each": "SELECT * FROM shown", "when": "{:kind = 3}"} */
SELECT method, 1000.0 / per_second AS "step_ms: step [ms]", error AS "error: {:axis}",
       fall_error AS "theory: g t step / 2 [mm]"
FROM did WHERE task = :task AND by_steps AND NOT keeps_energy ORDER BY contestant, point;

/* {"checks": "the broadphase does not matter"} */
SELECT 'With lists in canonical order, all broadphases give bit-identical states: their '
       || 'curves coincide', min(same), sum(same) || ' of ' || count(*) || ' settings'
FROM sameness;

-- The most that rounding in single precision adds to the error of a fall of two seconds, which is 20 m deep:
-- half a unit in the last place (of 24 bits) a step in speed and in place.
/* {"checks": "free fall"} */
SELECT 'Free fall has the error that theory predicts for such steps, within single precision',
       min(away <= rounding),
       'at most ' || fixed(max(away), 3) || ' mm from theory; rounding may add up to ' || fixed(max(rounding), 2)
       || ' mm with the shortest steps'
FROM (SELECT task, abs(error - fall_error) AS away, 1000 * 2 * 20 * 2.0 / 16777216 * per_second AS rounding
      FROM did WHERE task_name = 'fall' AND by_steps AND NOT keeps_energy)
GROUP BY task;

/* {"choices": "by what each task is about"} */
SELECT task_title || ', one simulated second', method || ', steps of ' || setting, ms, error,
       title || ': ' || error_text, ours, low
FROM did WHERE measure = 0;

/* {"conclusions": "our time against Bullet's"} */
SELECT 'In the median, ' || bullet.method || ' takes '
       || fixed(median(bullet.ms / us.ms), 2) || ' times as long as ' || us.method || ' ('
       || fixed(min(bullet.ms / us.ms), 2) || ' to '
       || fixed(max(bullet.ms / us.ms), 2) || ').'
FROM did AS us JOIN did AS bullet USING (point, measure, canonical)
WHERE us.ours AND NOT bullet.ours AND measure = 0
GROUP BY us.contestant, bullet.contestant;

-- The best that each way has reached in the first task.
/* {"conclusions": "what buys accuracy"} */
SELECT task_title || ', ' || way || ': at best ' || error_text || ', in ' || ms(ms)
       || ' ms per simulated second (' || setting || ').'
FROM (SELECT *, min(error) FROM did WHERE task = 0 AND measure = 0 AND contestant = 0 GROUP BY way)
     JOIN (SELECT way, min(point) AS first FROM points GROUP BY way) USING (way)
ORDER BY first;

-- What smaller steps do, under the first contestant.
/* {"conclusions": "smaller steps"} */
SELECT longest.task_title || iif(longest.keeps_energy, ', contacts that keep energy, ', ', ')
       || longest.title || ': ' || longest.error_text || ' with steps of ' || longest.step
       || ', ' || shortest.error_text || ' with '
       || shortest.step || iif(shortest.error > longest.error, '; smaller steps increase the error.', '.')
FROM (SELECT min(point) AS first, max(point) AS last FROM settings WHERE by_steps GROUP BY task, way)
     JOIN did AS longest ON longest.point = first
     JOIN did AS shortest ON shortest.point = last AND shortest.measure = longest.measure
WHERE longest.contestant = 0 AND shortest.contestant = 0
ORDER BY longest.keeps_energy, first, longest.measure;
)sql"
