R"sql(-- SPDX-License-Identifier: Zlib
--
-- What `hashphase try` says. Measured are, under the names that they have in its JSON: trial (one row); runs,
-- by turns with the broadphase "bullet" and with "hashphase", or one that is "verified"; steps, a row for each
-- of each run (of a program that makes none, for each calculation of pairs).

-- --- Which steps are compared ----------------------------------------------------------------------

CREATE TABLE turns AS
SELECT run, broadphase, row_number() OVER (PARTITION BY broadphase ORDER BY run) AS turn,
       ifnull(steps, 0) AS steps
FROM runs LEFT JOIN (SELECT run, count(*) AS steps FROM steps GROUP BY run) USING (run);

-- Turn by turn the first steps, as many as both runs have.
CREATE TABLE common AS
SELECT turn, min(steps) AS steps, max(steps) > min(steps) AS is_cut
FROM turns GROUP BY turn HAVING count(*) = 2;

-- And those of a run that was the only one.
CREATE TABLE compared AS
SELECT broadphase, numbered.*
FROM (SELECT *, row_number() OVER (PARTITION BY run ORDER BY rowid) AS number FROM steps) AS numbered
     JOIN turns USING (run) LEFT JOIN common USING (turn)
WHERE number <= common.steps OR (SELECT count(*) FROM runs) = 1;

-- Whether several threads of the program work in a step: whoever waits for others has no processor then, and
-- the clock on the wall is the one that tells how long a step takes. A look at the clock itself takes 0.02 ms,
-- the first time.
CREATE TABLE threads AS
SELECT ifnull(max(others > 0.1 * own), 0) AS on_threads
FROM (SELECT sum(allThreadsMs - stepProcessorMs - 0.02) AS others, sum(stepProcessorMs) AS own
      FROM compared WHERE allThreadsMs IS NOT NULL GROUP BY broadphase);

-- --- A step with either broadphase: means over the same steps of all runs --------------------------

CREATE TABLE lengths AS
SELECT *, updateAabbsMs + calculateMs AS own, updateAabbsProcessorMs + calculateProcessorMs AS own_processor,
       iif(on_threads, ifnull(stepMs, updateAabbsMs + calculateMs),
           ifnull(stepProcessorMs, updateAabbsProcessorMs + calculateProcessorMs)) AS length
FROM compared, threads;

-- By their length a twentieth of the steps on either side is set apart, of few none: machines have fits.
CREATE TABLE ranked AS
SELECT *, place > count / 20 AND place <= count - count / 20 AS is_usual,
       place > count - count / 20 AS is_slow
FROM (SELECT *, row_number() OVER (PARTITION BY broadphase ORDER BY length, run, number) AS place,
             count(*) OVER (PARTITION BY broadphase) AS count
      FROM lengths);

-- Times of the usual steps, so that parts add up. They are those of the processor, which other programs do not
-- lengthen, without a look at that clock (0.002 ms), which is not in the time on the wall: that is shorter
-- then. Where a step is on threads, those of the narrow phase, of rays and of whole steps are on the wall.
CREATE TABLE timed AS
SELECT broadphase,
       max(min(avg(updateAabbsMs), avg(updateAabbsProcessorMs)), avg(updateAabbsProcessorMs) - 0.002, 0)
           AS update_aabbs,
       max(min(avg(calculateMs), avg(calculateProcessorMs)), avg(calculateProcessorMs) - 0.002, 0)
           AS calculate,
       nullif(iif(on_threads, avg(narrowPhaseMs),
                  max(min(avg(narrowPhaseMs), avg(narrowPhaseProcessorMs)),
                      avg(narrowPhaseProcessorMs) - 0.002, 0)), 0) AS narrow_phase,
       iif(on_threads, avg(stepMs),
           max(min(avg(stepMs), avg(stepProcessorMs)), avg(stepProcessorMs) - 0.002, 0)) AS step,
       avg(stepMs) AS step_on_wall, avg(raysMs) AS rays, avg(raysBetweenMs) AS rays_between
FROM ranked WHERE is_usual GROUP BY broadphase;

-- Counts are those of all steps; `share` is that of its time in which the thread had a processor, where a step
-- is on threads in what waits for none of them.
CREATE TABLE counted AS
SELECT broadphase, on_threads, count(*) AS steps, avg(rays) AS ray_count,
       avg(raysBetween) AS ray_between_count, max(objects) AS objects,
       1.0 * sum(pairs) / sum(calculations) AS pairs,
       sum(iif(overlappingPairs IS NULL, 0, pairs)) AS pairs_looked_at,
       sum(overlappingPairs) AS overlapping_seen, sum(is_slow) AS slow_steps,
       sum(iif(is_slow, length, 0)) AS slow_time, sum(length) AS time,
       min(1, ifnull(1.0 * sum(iif(on_threads, own_processor, iif(is_usual, length, 0)))
                     / nullif(sum(iif(on_threads, own, iif(is_usual, ifnull(stepMs, own), 0))), 0),
                     1)) AS share
FROM ranked GROUP BY broadphase;

-- Of rays as much of their time on the wall as the thread had a processor; pairs that overlap are scaled up
-- from the steps in which they were counted.
CREATE TABLE summaries AS
SELECT *, update_aabbs + calculate + rays AS together, max(pairs - overlapping, 0) AS stale,
       iif(pairs < 100 AND pairs <> round(pairs), fixed(pairs, 1), thousands(round(pairs))) AS pairs_text,
       fixed(100 * share, iif(share < 0.1, 1, 0)) || ' %' AS share_text,
       fixed(100 * slow_share, iif(slow_share < 0.1, 1, 0)) || ' %' AS slow_text
FROM (SELECT broadphase, steps, update_aabbs, calculate, rays * iif(on_threads, 1, share) AS rays,
             narrow_phase, step, step_on_wall, share, ray_count,
             rays_between * iif(on_threads, 1, share) AS rays_between, ray_between_count, objects, pairs,
             CASE WHEN pairs_looked_at > 0 THEN pairs * overlapping_seen / pairs_looked_at
                  WHEN pairs = 0 THEN 0 END AS overlapping,
             ifnull(1.0 * slow_time / nullif(time, 0), 0) AS slow_share,
             1.0 * slow_time / max(slow_steps, 1) AS slow_step
      FROM counted JOIN timed USING (broadphase));

CREATE VIEW bullet AS SELECT * FROM summaries WHERE broadphase = 'bullet';
-- Nothing where nothing is compared.
CREATE VIEW ours AS SELECT * FROM summaries WHERE broadphase = 'hashphase';

-- --- How the program ends --------------------------------------------------------------------------

-- At a limit one that was stopped may have been about to end.
CREATE TABLE ends AS
SELECT run, broadphase, ended, iif(ended = 'was stopped', 'ended with status 0', ended) AS alike,
       ended NOT IN ('was stopped', 'ended with status 0') AS is_failure
FROM runs;

CREATE TABLE endings AS
SELECT (SELECT group_concat(ended, ' or ') FROM (SELECT DISTINCT ended FROM ends
                                                WHERE broadphase = 'bullet' ORDER BY ended)) AS bullet,
       (SELECT group_concat(ended, ' or ') FROM (SELECT DISTINCT ended FROM ends
                                                WHERE broadphase = 'hashphase' ORDER BY ended)) AS ours,
       EXISTS (SELECT alike FROM ends WHERE broadphase = 'hashphase' AND is_failure
               EXCEPT SELECT alike FROM ends WHERE broadphase = 'bullet') AS is_of_ours,
       (SELECT max(is_failure) FROM ends) AS any_failure,
       (SELECT ended FROM ends WHERE broadphase = 'bullet' AND is_failure ORDER BY run) AS failure;

-- What was tried, and whether all is well: steps were compared, or pairs verified, and are right; and with ours the
-- program succeeds, or fails only as it does with Bullet's.
/* {"verdict": "trial"} */
SELECT program || ': ' || iif(dbvts > 0, thousands(dbvts) || ' btDbvtBroadphase' || iif(dbvts > 1, 's, ', ', '), '')
       || iif(axisSweeps > 0, thousands(axisSweeps) || ' axis sweep' || iif(axisSweeps > 1, 's, ', ', '), '')
       || iif(derivedSweeps > 0, thousands(derivedSweeps)
              || ' of a class derived from an axis sweep (not replaced), ', '')
       || precision || ' precision' || ifnull(', ' || bullet, ''),
       NOT is_of_ours AND (SELECT min(hasBroadphase) FROM runs)
       AND CASE runs.broadphase
               WHEN 'verified' THEN calculations > 0 AND missing + extra = 0 AND NOT isCrash
               ELSE EXISTS (SELECT 1 FROM ours) END
FROM trial, runs, (SELECT is_of_ours FROM endings) WHERE run = 1;

-- --- For people ------------------------------------------------------------------------------------

CREATE TABLE notes AS
SELECT thousands(number) || ' calculations of pairs were in broadphases that hashphase does not replace.' AS note
FROM (SELECT max(foreignCalculations) AS number FROM runs) WHERE number > 0
UNION ALL
SELECT thousands(number) || ' further process' || iif(number > 1, 'es', '')
       || ' made a broadphase or inherited a copy, and ' || iif(number > 1, 'are', 'is')
       || ' not in these figures.'
FROM (SELECT max(otherProcesses) AS number FROM runs) WHERE number > 0
UNION ALL
SELECT 'At most ' || thousands(room) || ' steps are recorded; ' || thousands(number)
       || ' more steps are not in these figures.'
FROM trial, (SELECT max(droppedSteps) AS number FROM runs) WHERE number > 0
UNION ALL
SELECT 'Run ' || run || ' made no broadphase and ' || ended || '; no further run followed.'
FROM runs WHERE run = (SELECT max(run) FROM runs) AND NOT hasBroadphase;

CREATE TABLE figures AS
SELECT 'ms' AS kind, 'updateAabbs [ms]' AS name, b.update_aabbs AS bullet, h.update_aabbs AS ours
FROM bullet AS b, ours AS h
UNION ALL
SELECT 'ms', 'calculateOverlappingPairs [ms]', b.calculate, h.calculate FROM bullet AS b, ours AS h
UNION ALL
SELECT 'ms', 'rays and their callbacks [ms]', b.rays, h.rays FROM bullet AS b, ours AS h
UNION ALL
SELECT 'ms', 'whole broadphase [ms]', b.together, h.together FROM bullet AS b, ours AS h
UNION ALL
SELECT 'ms', 'narrow phase [ms]', ifnull(b.narrow_phase, 0), ifnull(h.narrow_phase, 0)
FROM bullet AS b, ours AS h WHERE coalesce(b.narrow_phase, h.narrow_phase) IS NOT NULL
UNION ALL
SELECT 'ms', 'whole step [ms]', b.step, h.step FROM bullet AS b, ours AS h WHERE b.step + h.step IS NOT NULL
UNION ALL
SELECT 'share', 'share of the broadphase', b.together / b.step, h.together / h.step
FROM bullet AS b, ours AS h WHERE b.step + h.step IS NOT NULL
UNION ALL
SELECT 'count', 'pairs', b.pairs, h.pairs FROM bullet AS b, ours AS h
UNION ALL
SELECT 'count', 'overlapping pairs', b.overlapping, h.overlapping FROM bullet AS b, ours AS h
UNION ALL
SELECT 'count', 'rays', b.ray_count, h.ray_count FROM bullet AS b, ours AS h
UNION ALL
SELECT 'count', 'rays between steps', b.ray_between_count, h.ray_between_count
FROM bullet AS b, ours AS h WHERE b.ray_between_count + h.ray_between_count > 0
UNION ALL
SELECT 'ms', 'rays between steps, time [ms]', b.rays_between, h.rays_between
FROM bullet AS b, ours AS h WHERE b.ray_between_count + h.ray_between_count > 0
UNION ALL
SELECT 'count', 'objects at most', b.objects, h.objects FROM bullet AS b, ours AS h
UNION ALL
SELECT 'count', 'steps', b.steps, h.steps FROM bullet AS b, ours AS h;


/* {"rows": "compared steps"} */
SELECT name AS "a step",
       CASE kind WHEN 'ms' THEN ms(bullet)
                 WHEN 'share' THEN ifnull(fixed(100 * bullet, iif(bullet < 0.1, 1, 0)) || ' %', '-')
                 ELSE coalesce(iif(bullet < 100 AND bullet <> round(bullet), fixed(bullet, 1),
                                   thousands(round(bullet))), '-') END AS "Bullet's",
       CASE kind WHEN 'ms' THEN ms(ours)
                 WHEN 'share' THEN ifnull(fixed(100 * ours, iif(ours < 0.1, 1, 0)) || ' %', '-')
                 ELSE coalesce(iif(ours < 100 AND ours <> round(ours), fixed(ours, 1),
                                   thousands(round(ours))), '-') END AS hashphase,
       iif(kind = 'ms', ifnull(fixed(ratio, iif(ratio < 10, 2, 1)) || 'x', '-'), '') AS ratio
FROM (SELECT *, 1.0 * bullet / nullif(ours, 0) AS ratio FROM figures);

-- What the change of a step consists of, in parts that add up; not those that round to nothing.
CREATE TABLE changes AS
SELECT iif(ms(abs(bullet - ours)) <> ms(0),
           ms(abs(bullet - ours)) || iif(ours > bullet, ' ms more ', ' ms less ') || place,
           'the same time ' || place || iif(saved >= 1, '', NULL))
       || iif(saved >= 1, visits, '') AS change
FROM (SELECT 'in the broadphase' AS place, b.together AS bullet, h.together AS ours, 0 AS saved, '' AS visits
      FROM bullet AS b, ours AS h
      UNION ALL
      SELECT 'in the narrow phase', b.narrow_phase, h.narrow_phase, saved,
             ', which visits ' || h.pairs_text || ' pairs instead of ' || b.pairs_text || ', '
             || iif(saved < 100 AND saved <> round(saved), fixed(saved, 1), thousands(round(saved)))
             || ' of which do not overlap'
      FROM bullet AS b, ours AS h, (SELECT ifnull(b.stale, 0) - ifnull(h.stale, 0) AS saved
                                    FROM bullet AS b, ours AS h)
      WHERE b.narrow_phase + h.narrow_phase IS NOT NULL
      UNION ALL
      SELECT 'elsewhere', b.step - b.together - ifnull(b.narrow_phase, 0),
             h.step - h.together - ifnull(h.narrow_phase, 0), 0, '' FROM bullet AS b, ours AS h);
DELETE FROM changes WHERE change IS NULL;

/* {"rows": "comparison"} */
SELECT 'Times are the calling thread''s processor time'
       || iif(on_threads, ', except for the narrow phase, rays and whole steps. Several threads work in these: '
                          || 'their times are wall-clock times.', '.')
FROM ours, threads
UNION ALL
SELECT note FROM notes
UNION ALL
SELECT 'Only the first steps are compared, as many as both runs have: with Bullet''s broadphase there were '
       || thousands(bullet) || ', with hashphase ' || thousands(ours) || '.'
FROM (SELECT sum(iif(broadphase = 'bullet', turns.steps, 0)) AS bullet,
             sum(iif(broadphase = 'hashphase', turns.steps, 0)) AS ours, max(is_cut) AS is_cut
      FROM turns JOIN common USING (turn)), (SELECT 1 FROM ours) WHERE is_cut
UNION ALL
SELECT 'Times exclude the slowest 5 % of the steps. These steps took ' || b.slow_text
       || ' of all time with Bullet''s and ' || h.slow_text || ' with hashphase: ' || ms(b.slow_step) || ' and '
       || ms(h.slow_step) || ' ms a step.'
FROM bullet AS b, ours AS h WHERE max(b.slow_share, h.slow_share) > 0.2
UNION ALL
SELECT 'These are few steps: take the figures as a hint.' FROM ours WHERE steps < 60
UNION ALL
SELECT 'The numbers of objects differ: the program does something else in each run.'
FROM bullet AS b, ours AS h WHERE b.objects <> h.objects
UNION ALL
SELECT ifnull('With hashphase a step takes ' || ms(h.step) || ' ms instead of ' || ms(b.step) || ' ('
              || ifnull(fixed(b.step / h.step, iif(b.step / h.step < 10, 2, 1)) || 'x', '-') || ')'
              || ifnull((SELECT group_concat(CASE WHEN place = 1 THEN ': ' WHEN place < parts THEN ', '
                                                  ELSE ', and ' END || change, '')
                         FROM (SELECT change, row_number() OVER (ORDER BY rowid) AS place,
                                      count(*) OVER () AS parts FROM changes)), '') || '.',
              'The program made no steps: it calculated pairs itself.')
FROM bullet AS b, ours AS h
UNION ALL
SELECT ifnull(overload, 'Other programs were busy, or the program waited for something')
       || CASE WHEN min(b.share, h.share) >= 0.9
                   THEN iif(on_threads, ', which lengthens the wall-clock times.',
                            ', but the times above exclude waiting.')
               ELSE ': the calling thread ran for ' || b.share_text || ' of the time with Bullet''s, and for '
                    || h.share_text || ' with hashphase. '
                    || CASE WHEN on_threads THEN 'Trust the times of updateAabbs and calculateOverlappingPairs, '
                                                 || 'not the wall-clock times.'
                            WHEN b.step + h.step IS NULL THEN 'Trust the times above.'
                            ELSE 'Trust the times above, not the wall-clock times: '
                                 || ms(b.step_on_wall) || ' and ' || ms(h.step_on_wall) || ' ms a step ('
                                 || ifnull(fixed(wall_ratio, iif(wall_ratio < 10, 2, 1)) || 'x', '-') || ').'
                            END END
FROM bullet AS b, ours AS h, threads, trial,
     (SELECT b.step_on_wall / nullif(h.step_on_wall, 0) AS wall_ratio FROM bullet AS b, ours AS h)
WHERE overload IS NOT NULL OR min(b.share, h.share) < 0.9
UNION ALL
-- Of a trial that was ended in its first run, or whose program does something else each time.
SELECT ifnull((SELECT 'There was no run with hashphase. With Bullet''s broadphase, updateAabbs, '
                      || 'calculateOverlappingPairs and rays took ' || ms(together) || ' ms'
                      || ifnull(' of the ' || ms(step) || ' ms', '') || ' of a step; ' || thousands(steps)
                      || ' steps, at most ' || thousands(objects) || ' objects, ' || pairs_text || ' pairs.'
               FROM bullet),
              'No steps were compared: the runs have no common steps in which pairs were calculated.')
FROM endings WHERE bullet IS NOT NULL AND NOT EXISTS (SELECT 1 FROM ours)
UNION ALL
-- What it ended with matters more than what it took.
SELECT CASE WHEN is_of_ours OR (any_failure AND bullet IS NOT ours)
                THEN 'The program ' || bullet || ' with Bullet''s broadphase'
                     || ifnull(', and ' || ours || ' with hashphase', '') || '.'
            ELSE 'The program ' || failure || ' with either broadphase.' END
FROM endings WHERE bullet IS NOT NULL AND (is_of_ours OR any_failure);

-- --- Of pairs that were verified -------------------------------------------------------------------

CREATE VIEW verification AS SELECT * FROM runs WHERE broadphase = 'verified';

/* {"rows": "verified pairs"} */
SELECT 'hashphase' AS pairs, thousands(pairs - extra) AS right, thousands(missing) AS missing,
       thousands(extra) AS extra
FROM verification WHERE calculations > 0
UNION ALL
SELECT 'Bullet''s', thousands(bulletPairs - bulletExtra), thousands(bulletMissing), thousands(bulletExtra)
FROM verification WHERE calculations > 0;

/* {"rows": "verification"} */
SELECT thousands(number) || ' times a pair was ' || what
FROM (SELECT calculations, waitForAMove AS number, 'refused that the filter would now accept: the filter '
             || 'was changed, and the objects have not moved since. See refilter().' AS what FROM verification
      UNION ALL
      SELECT calculations, removedByProgram, 'missing because the program itself removed it from its pair cache: '
             || 'hashphase lists it again when its objects meet again.' FROM verification
      UNION ALL
      SELECT calculations, notJudged, 'not checked because a callback moved one of its objects while pairs '
             || 'were calculated: the next calculation checks it.' FROM verification)
WHERE calculations > 0 AND number > 0
UNION ALL
SELECT 'The first fault: ' || firstFault || '.' FROM verification WHERE calculations > 0
UNION ALL
SELECT thousands(calculations) || ' calculations of pairs verified: the pairs of hashphase are '
       || iif(missing + extra = 0, 'exact in each', 'NOT EXACT') || '.'
FROM verification WHERE calculations > 0
UNION ALL
SELECT CASE WHEN calculations > 0 THEN 'The program ' || ended || '.'
            WHEN isCrash THEN 'The program ' || ended || ' before any pairs were calculated.'
            ELSE 'Nothing was verified: no pairs were calculated, and the program ' || ended || '.' END
FROM verification JOIN ends USING (run, ended) WHERE calculations = 0 OR is_failure;

-- --- For programs ----------------------------------------------------------------------------------

-- Projected: the step with Bullet's broadphase, of which ours takes the place.
/* {"rows": "trial"} */
SELECT program, bullet, precision,
       (SELECT iif(on_threads, 'wall', 'processor') FROM threads, ours) AS clock,
       (SELECT b.step - b.together + h.together FROM bullet AS b, ours AS h) AS projectedStepMs
FROM trial;

/* {"rows": "means"} */
SELECT steps, update_aabbs AS updateAabbsMs, calculate AS calculateMs, rays AS raysMs,
       narrow_phase AS narrowPhaseMs, step AS stepMs, step_on_wall AS stepWallMs, share AS processorShare,
       ray_count AS rays, rays_between AS raysBetweenMs, ray_between_count AS raysBetween, objects, pairs,
       overlapping AS overlappingPairs, stale AS stalePairs
FROM summaries WHERE EXISTS (SELECT 1 FROM ours) ORDER BY broadphase;

/* {"rows": "verified"} */
SELECT calculations, pairs, missing, extra, waitForAMove, removedByProgram, notJudged, bulletPairs,
       bulletMissing, bulletExtra, firstFault
FROM verification;

/* {"rows": "runs"} */
SELECT broadphase, ended, dbvts, axisSweeps, derivedSweeps, droppedSteps, foreignCalculations, otherProcesses
FROM runs ORDER BY run;
)sql"
