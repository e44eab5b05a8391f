R"sql(-- SPDX-License-Identifier: Zlib
--
-- What is shown of all cases, of which case.sql has made `did` and `outcomes`.

-- How the automatic cell size did against the fixed one of the lowest median.
CREATE TABLE regrets AS
SELECT automatic."case", automatic.ms, best.name AS best, best.ms AS best_ms,
       (SELECT median(theirs.ms / ours.ms) FROM frames AS ours JOIN frames AS theirs USING (frame)
        WHERE ours.contestant = best.contestant AND theirs.contestant = automatic.contestant
              AND ours.ms > 0) - 1 AS regret
FROM did AS automatic JOIN cases ON cases.rowid = automatic."case" AND "group" = 'cell size'
     JOIN (SELECT *, min(ms) FROM did WHERE name <> 'cells-auto' AND ms IS NOT NULL GROUP BY "case") AS best
          ON best."case" = automatic."case"
WHERE automatic.name = 'cells-auto' AND automatic.ms IS NOT NULL;

-- What declared effects take of the frame by hand, and what they may: of a scene without the other
-- effects, and of one whose bodies do not take part in them.
CREATE TABLE overheads AS
SELECT did."case", did.contestant, did.name, did.frames, median(own.ms / hand.ms) AS ratio,
       percentile(own.ms / hand.ms, 0.05) AS low, percentile(own.ms / hand.ms, 0.95) AS high,
       CASE did.name WHEN 'declared' THEN 1.01 WHEN 'nobody' THEN 1.02 END AS bound
FROM did JOIN cases ON cases.rowid = did."case" AND "group" = 'effects'
     JOIN did AS by_hand ON by_hand."case" = did."case" AND by_hand.name = 'by-hand'
     JOIN frames AS own ON own.contestant = did.contestant
     JOIN frames AS hand ON hand.contestant = by_hand.contestant AND hand.frame = own.frame
WHERE did.name <> 'by-hand' GROUP BY did.contestant;

-- What saving and going back take beside the frame, in the same frame.
CREATE TABLE shares AS
SELECT did."case", did.contestant, did.name, did.frames, did.ms, median(1.0 * own.ms / frame.ms) AS share,
       percentile(1.0 * own.ms / frame.ms, 0.05) AS low, percentile(1.0 * own.ms / frame.ms, 0.95) AS high,
       did.own_for_objects AS bytes
FROM did JOIN cases ON cases.rowid = did."case" AND "group" = 'snapshots'
     JOIN did AS whole ON whole."case" = did."case" AND whole.name = 'frame'
     JOIN frames AS own ON own.contestant = did.contestant
     JOIN frames AS frame ON frame.contestant = whole.contestant AND frame.frame = own.frame
WHERE did.name <> 'frame' GROUP BY did.contestant;

-- Schema "hashphase-benchmarks", case by case; what was not measured is null.
CREATE VIEW case_json AS
SELECT json_object(
    'name', name, 'group', "group", 'description', description, 'objects', objects, 'operation', operation,
    'operationsPerFrame', operations, 'warmUpFrames', warm_up_frames, 'framesDone', frames_done,
    'timeLimitHit', json(iif(frames_done < frames_asked, 'true', 'false')),
    'oursExact', json(iif(ours_exact, 'true', 'false')),
    'cellSizeRegret', json((SELECT json_object('regret', regret, 'bestFixed', best) FROM regrets
                            WHERE regrets."case" = outcomes."case")),
    'effectsOverheads', json((
        SELECT json_group_array(json_object(
            'contestant', name, 'ratio', json_object('median', ratio, 'p5', low, 'p95', high),
            'bound', bound, 'holds', json(iif(ratio > bound, 'false', 'true'))))
        FROM overheads WHERE overheads."case" = outcomes."case")),
    'snapshotShares', json((
        SELECT json_group_array(json_object(
            'contestant', name, 'share', json_object('median', share, 'p5', low, 'p95', high)))
        FROM shares WHERE shares."case" = outcomes."case")),
    'contestants', json((
        SELECT json_group_array(json_object(
            'name', name, 'title', title, 'package', package, 'ours', json(iif(ours, 'true', 'false')),
            'fillMs', fill_ms,
            'ms', json(iif(ms IS NULL, 'null', json_object('median', ms, 'p5', low, 'p95', high))),
            'nsPerOperation', ms * 1e6 / nullif(operations, 0), 'speedAgainstDbvt', speed,
            'droppedOut', json(iif(dropped_out, 'true', 'false')),
            'answers', json_object('framesChecked', checked, 'answers', answers, 'exact', exact,
                                   'missing', missing, 'extra', extra, 'duplicates', duplicates),
            'firstFault', first_fault,
            'memory', json_object('heapBytes', heap_bytes, 'ownBytesForObjects', own_for_objects,
                                  'ownBytesForPairs', own_for_pairs),
            'frameMs', json((SELECT json_group_array(frames.ms) FROM frames
                             WHERE frames.contestant = did.contestant))))
        FROM did WHERE did."case" = outcomes."case"))) AS json
FROM outcomes;

-- --- The summary ---------------------------------------------------------------------------------------

CREATE TABLE others AS  -- the fastest of those that are not ours, in each case
SELECT *, min(ms) FROM did WHERE NOT ours AND ms IS NOT NULL GROUP BY "case";

-- Cell sizes, effects and snapshots have tables of their own; among the sweeps, `hash` is told nothing of the motions.
/* {"print": "Speed: the other broadphase's time divided by hashphase's in the same frame, median over the frames."} */
SELECT "case", exact, "hash ns", iif(dbvt IS NULL, '-', fixed(dbvt, iif(dbvt < 10, 2, 1)) || 'x') AS "hash / dbvt",
       iif(grid IS NULL, '-', fixed(grid, iif(grid < 10, 2, 1)) || 'x') AS "grid / dbvt", "fastest other",
       iif(that IS NULL, '-', fixed(that, iif(that < 10, 2, 1)) || 'x') AS "hash / that"
FROM (SELECT outcomes.name AS "case", iif(ours_exact, 'yes', 'NO') AS exact,
             hash.ms * 1e6 / max(outcomes.operations, 1) AS "hash ns", hash.speed AS dbvt,
             grid.speed AS grid, others.name AS "fastest other",
             (SELECT median(theirs.ms / ours.ms) FROM frames AS ours JOIN frames AS theirs USING (frame)
              WHERE ours.contestant = hash.contestant AND theirs.contestant = others.contestant
                    AND ours.ms > 0) AS that
      FROM outcomes LEFT JOIN did AS hash ON hash."case" = outcomes."case" AND hash.name = 'hash'
           LEFT JOIN did AS grid ON grid."case" = outcomes."case" AND grid.name = 'grid'
           LEFT JOIN others ON others."case" = outcomes."case"
      WHERE outcomes."group" NOT IN ('cell size', 'effects', 'snapshots') AND coalesce(hash.ours, 1));

/* {"print": "Cell sizes, fixed ones in mean edges. Regret: how much longer automatic sizes took than the best fixed size."} */
SELECT name AS "case", ms * 1e6 / operations AS "automatic ns", best AS "best fixed",
       best_ms * 1e6 / operations AS "its ns", fixed(100 * regret, 1) || ' %' AS regret
FROM regrets JOIN cases ON cases.rowid = "case";

/* {"print": "Effects: the time of a declared frame divided by the time of a hand-written one, median over the frames and 5th and 95th percentile."} */
SELECT cases.name AS "case", overheads.name AS contestant, frames, fixed(ratio, 4) AS "/ by-hand",
       fixed(low, 4) AS "5 %", fixed(high, 4) AS "95 %", fixed(bound, 2) AS bound,
       CASE WHEN bound IS NULL THEN '-' WHEN ratio <= bound THEN 'yes' ELSE 'NO' END AS holds
FROM overheads JOIN cases ON cases.rowid = "case";

/* {"print": "Snapshots: the times of saving and restoring as shares of the frame's time, median over the frames and 5th and 95th percentile."} */
SELECT cases.name AS "case", shares.name AS contestant, frames, ms(ms) AS ms, fixed(100 * share, 2) || ' %' AS share,
       fixed(100 * low, 2) || ' %' AS "5 %", fixed(100 * high, 2) || ' %' AS "95 %",
       fixed(1.0 * bytes / objects, 0) AS "bytes an object"
FROM shares JOIN cases ON cases.rowid = "case";

/* {"conclusions": "of all random scenes"} */
SELECT 'Random scenes: hash was ' || fixed(median(speed), iif(median(speed) < 10, 2, 1))
       || 'x dbvt in the median of ' || count(*) || ', ' || fixed(min(speed), iif(min(speed) < 10, 2, 1))
       || 'x in the worst, ' || fixed(max(speed), iif(max(speed) < 10, 2, 1)) || 'x in the best.'
FROM did JOIN cases ON cases.rowid = "case" WHERE "group" = 'random' AND did.name = 'hash' AND speed > 0
HAVING count(*) > 0;

/* {"conclusions": "of all cell sizes"} */
SELECT 'Regret: median ' || fixed(100 * median(regret), 1) || ' %, worst ' || fixed(100 * max(regret), 1)
       || ' % of ' || count(*) || ' cases.'
FROM regrets HAVING count(*) > 0;

/* {"verdict": "every checked answer of hashphase was right"} */
SELECT 'All answers of ours exact: ' || iif(coalesce(min(ours_exact), 1), 'yes', 'NO'),
       coalesce(min(ours_exact), 1)
FROM outcomes;
)sql"
