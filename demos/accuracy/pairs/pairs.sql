R"sql(-- SPDX-License-Identifier: Zlib
--
-- What P2 and P10 share. Measured are: trials, ways (the methods of a trial), judged (a row for each way and
-- frame), heap (each way, after the first frames), times (each mean of some frames) of ways that were
-- timed; truths (frames in which brute force judged the sweep).

CREATE TABLE did AS
WITH sums AS (SELECT trial, way, count(*) AS frames, sum(true_pairs) AS true_pairs, sum(missed) AS missed,
                     sum(extra) AS extra, avg(tested) AS tested FROM judged GROUP BY trial, way),
     shares AS (SELECT *, iif(true_pairs = 0, 0, 1.0 * missed / true_pairs) AS missed_share,
                       iif(true_pairs = 0, 0, 1.0 * extra / true_pairs) AS extra_share FROM sums),
     medians AS (SELECT trial, way, median(ms) AS ms, percentile(ms, 0.05) AS ms_low FROM times
                 GROUP BY trial, way)
SELECT *, 1e6 * ms / objects AS ns,
       iif(missed = 0 AND extra = 0, 'exactly the overlapping pairs',
           iif(missed = 0, 'misses no pair', 'misses ' || number(100 * missed_share) || ' % of the pairs')
           || iif(extra = 0, ', no false pairs', ', lists ' || number(100 * extra_share) || ' % too many pairs'))
       AS result
FROM trials JOIN ways USING (trial) JOIN shares USING (trial, way) JOIN heap USING (trial, way)
     LEFT JOIN medians USING (trial, way)
ORDER BY trial, way;

CREATE TABLE bullet AS SELECT trial, ns AS bullet_ns, result FROM did WHERE method = 'btDbvtBroadphase';

CREATE VIEW results AS
SELECT did.*, bullet_ns / ns AS speed, coalesce(interval_low(missed, true_pairs, frames), 0) AS low,
       coalesce(interval_high(missed, true_pairs, frames), 1) AS high
FROM did LEFT JOIN bullet USING (trial) ORDER BY did.rowid;

/* {"checks": "what ways promise"} */
SELECT 'Every exact method lists exactly the overlapping pairs',
       sum(missed) = 0 AND sum(extra) = 0 AND sum(true_pairs) > 0,
       thousands(total(missed)) || ' missed and ' || thousands(total(extra)) || ' false of '
       || thousands(total(true_pairs)) || ' pairs in ' || count(*) || ' runs'
       || coalesce('; first fault: ' || (SELECT method FROM did WHERE exact AND missed + extra > 0), '')
FROM did WHERE exact
UNION ALL
SELECT 'Methods that may list false pairs miss no pair', sum(missed) = 0,
       thousands(total(missed)) || ' missed and ' || thousands(total(extra)) || ' false of '
       || thousands(total(true_pairs)) || ' pairs in ' || count(*) || ' runs'
       || coalesce('; first fault: ' || (SELECT method FROM did WHERE complete AND NOT exact AND missed > 0), '')
FROM did WHERE complete AND NOT exact GROUP BY complete
UNION ALL
SELECT 'The sweep that finds the true pairs agrees with brute force', sum(differs) = 0,
       sum(differs) || ' of ' || count(*) || ' frames of up to 20,000 objects differ'
FROM truths;
)sql"
