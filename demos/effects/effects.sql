R"sql(-- SPDX-License-Identifier: Zlib
--
-- What each effect of a scene costs, and what the scene lacks without it. What priceEffects() measures: run (one
-- row); variants, of which the first is the whole scene; frames of each; probes of each, in some of the frames;
-- results, each of which must be that of the whole scene; numbers, of each variant its counters, as sums of all
-- frames, and its tables [bytes]; compared, for each effect the variants whose difference it is.

CREATE TABLE spreads AS
SELECT variant, median(ms) AS ms, percentile(ms, 0.05) AS low, percentile(ms, 0.95) AS high,
       avg(allocations) AS allocations, ifnull(avg(visible), 0) AS visible, ifnull(avg(pairs), 0) AS present,
       (SELECT sum(number) FROM numbers WHERE numbers.variant = frames.variant AND kind = 'table') AS bytes
FROM frames GROUP BY variant;

-- Of what people are told: counters a frame, and means.
CREATE TABLE means AS
SELECT variant, name, 1.0 * number / max(frames, 1) AS number FROM numbers, run WHERE kind = 'counter'
UNION ALL SELECT variant, 'offGround', avg(off_ground) FROM probes GROUP BY variant
UNION ALL SELECT variant, 'interpenetrating', avg(interpenetrating) FROM probes GROUP BY variant
UNION ALL SELECT variant, 'present', present FROM spreads
UNION ALL SELECT variant, 'hidden', objects - visible FROM spreads, run
UNION ALL SELECT variants.rowid, 'objects', objects FROM variants, run;

-- What an effect does, and what is lost without it, part by part: a number of the whole scene, or of it
-- without the effect ('less'), or by how much that is more ('more').
CREATE TABLE parts (said, effect, variant, name, before, after);
INSERT INTO parts VALUES
('work', 'motion', 'whole', 'bodiesMoved', '', ' bodies moved'),
('work', 'terrain', 'whole', 'groundsAsked', '', ' bodies'),
('work', 'terrain', 'whole', 'trianglesTested', ', ', ' triangles'),
('work', 'pairs', 'whole', 'boxesTested', '', ' boxes tested'),
('work', 'pairs', 'whole', 'pairsBorn', ', ', ' new pairs'),
('work', 'response', 'whole', 'contactsTested', '', ' contacts'),
('work', 'response', 'whole', 'contactsSolved', ', ', ' bounces'),
('work', 'sweep', 'whole', 'sweepsSolved', '', ' sweeps'),
('work', 'sweep', 'whole', 'sweepBoxesTested', ', ', ' boxes'),
('work', 'sleeping', 'whole', 'fellAsleep', '', ' fell asleep'),
('work', 'sleeping', 'whole', 'wokeUp', ', ', ' woke'),
('work', 'picking', 'whole', 'picks', '', ' rays'),
('work', 'picking', 'whole', 'pickBoxesTested', ', ', ' boxes'),
('work', 'boxSelection', 'whole', 'selections', '', ' rectangles'),
('work', 'boxSelection', 'whole', 'selectionBoxesTested', ', ', ' boxes'),
('work', 'culling', 'whole', 'cellRowsCulled', '', ' rows of cells'),
('work', 'culling', 'whole', 'cullingBoxesTested', ', ', ' boxes'),
('work', 'proximity', 'whole', 'agentsScanned', '', ' agents'),
('work', 'proximity', 'whole', 'neighboursTested', ', ', ' distances'),
('work', 'zones', 'whole', 'zonesTested', '', ' zones'),
('work', 'zones', 'whole', 'zoneBoxesTested', ', ', ' boxes'),
('work', 'radar', 'whole', 'radarScans', '', ' scans'),
('work', 'radar', 'whole', 'radarBoxesTested', ', ', ' boxes'),
('lost', 'motion', 'whole', 'bodiesMoved', '', ' bodies stand still'),
('lost', 'terrain', 'less', 'offGround', '', ' bodies off the ground ('),
('lost', 'terrain', 'whole', 'offGround', '', ' with terrain)'),
('lost', 'pairs', 'whole', 'present', '', ' unknown pairs'),
('lost', 'response', 'less', 'interpenetrating', '', ' pairs inside each other ('),
('lost', 'response', 'whole', 'interpenetrating', '', ' with response)'),
('lost', 'sweep', 'whole', 'sweepersStopped', '', ' bodies fly through what they hit'),
('lost', 'sleeping', 'more', 'bodiesMoved', '', ' more bodies move invisibly'),
('lost', 'picking', 'whole', 'picks', '', ' clicks without an answer'),
('lost', 'boxSelection', 'whole', 'selections', '', ' rectangles without an answer'),
('lost', 'culling', 'whole', 'hidden', '', ' bodies drawn needlessly'),
('lost', 'culling', 'late', 'framesCulledLate', '; late in ', ' % of frames with culling'),
('lost', 'proximity', 'whole', 'objects', '', ' agents that see no other agent'),
('lost', 'proximity', 'late', 'agentsLate', '; ', ' are late with proximity'),
('lost', 'zones', 'whole', 'zonesTested', '', ' zones that report nothing'),
('lost', 'zones', 'late', 'zonesLate', '; ', ' are late with zones'),
('lost', 'radar', NULL, NULL, 'no radar', ''),
('lost', 'radar', 'late', 'radarsLate', '; late in ', ' % of frames with radar');

CREATE TABLE said AS
SELECT effect, group_concat(iif(said = 'work', text, NULL), '') AS work,
       group_concat(iif(said = 'lost', text, NULL), '') AS lost
FROM (SELECT effect, said, before || ifnull(CASE
                 WHEN before = '; late in ' THEN fixed(100 * number, 0)
                 WHEN number < 9.95 AND number <> round(number) THEN fixed(number, 1)
                 ELSE thousands(round(number)) END, '') || after AS text
      FROM (SELECT parts.rowid AS turn, effect, said, parts.variant, before, after,
                   CASE parts.variant WHEN 'less' THEN less.number WHEN 'more' THEN less.number - whole.number
                                ELSE whole.number END AS number
            FROM compared JOIN parts USING (effect)
                 LEFT JOIN means AS whole ON whole.name = parts.name AND whole.variant = 1
                 LEFT JOIN means AS less ON less.name = parts.name AND less.variant = all_without)
      WHERE variant IS NOT 'late' OR number > 0 ORDER BY effect, turn)
GROUP BY effect;

-- The differences, frame by frame.
CREATE TABLE differences AS
SELECT compared.rowid AS price, compared.effect, which, median(a.ms - b.ms) AS ms,
       percentile(a.ms - b.ms, 0.05) AS low, percentile(a.ms - b.ms, 0.95) AS high
FROM (SELECT rowid, effect, 'alone' AS which, alone AS more, alone_without AS less FROM compared
      UNION ALL SELECT rowid, effect, 'within all', 1, all_without FROM compared) AS compared
     JOIN frames AS a ON a.variant = more JOIN frames AS b ON b.variant = less AND b.frame = a.frame
GROUP BY price, which;

CREATE TABLE prices AS
SELECT compared.effect, alone.ms AS alone_ms, alone.low AS alone_low, alone.high AS alone_high,
       in_all.ms AS in_all_ms, in_all.low AS in_all_low, in_all.high AS in_all_high,
       (SELECT bytes FROM spreads WHERE variant = compared.alone)
           - (SELECT bytes FROM spreads WHERE variant = alone_without) AS alone_bytes,
       (SELECT bytes FROM spreads WHERE variant = 1)
           - (SELECT bytes FROM spreads WHERE variant = all_without) AS in_all_bytes,
       ifnull(work, '') AS work, ifnull(lost, '') AS lost
FROM compared JOIN differences AS alone ON alone.effect = compared.effect AND alone.which = 'alone'
     JOIN differences AS in_all ON in_all.effect = compared.effect AND in_all.which = 'within all'
     LEFT JOIN said ON said.effect = compared.effect
ORDER BY compared.rowid;

-- Next to the prices: why a time is below zero.
CREATE TABLE below_zero AS
SELECT effect || ' ' || which || ', ' || ms(ms) || ' ms: '
       || iif(high > 0, 'less than the variation between frames (' || ms(low) || ' to ' || ms(high)
                        || ' ms), so too small to measure.',
              'a frame takes less time with the effect, because the effect saves other effects more time '
              || 'than it takes.') AS sentence
FROM (SELECT * FROM differences WHERE ms < 0 ORDER BY price, which);

CREATE TABLE checks AS
SELECT 'An undeclared effect does nothing and takes no memory' AS claim, strays IS NULL AS holds,
       ifnull('not 0:' || strays, thousands(zeros) || ' counters and tables of undeclared effects are 0')
           AS evidence
FROM (SELECT count(*) AS zeros,
             group_concat(iif(number = 0, NULL, ' ' || name || ' with ' || effects || ';'), '') AS strays
      FROM numbers JOIN variants ON variants.rowid = variant WHERE NOT is_declared)
UNION ALL
SELECT 'A declared effect finds bit-identical results, whichever other effects are declared', differences = 0,
       thousands(differences) || ' of ' || thousands(comparisons) || ' results differ'
FROM (SELECT ifnull(sum(differs), 0) AS differences, count(effect) AS comparisons FROM results);

CREATE VIEW texts AS
SELECT scene || ': ' || thousands(objects) || ' bodies, ' || effects AS scene, thousands(frames) AS frames,
       stopped
FROM run, variants WHERE variants.rowid = 1;

/* {"verdict": "all"} */
SELECT texts.frames || ' frames: the whole scene ' || ms(ms) || ' ms a frame, ' || bytes(bytes)
       || iif(all_hold, '; undeclared effects cost nothing', '; A CHECK FAILED, see above'),
       all_hold
FROM texts, spreads, (SELECT min(holds) AS all_hold FROM checks) WHERE variant = 1;

-- --- On the terminal ------------------------------------------------------------------------------

/* {"print": "{scene}\n"} */
SELECT effect, ms(alone_ms) AS "alone ms", ms(in_all_ms) AS "in all ms", bytes(alone_bytes) AS "bytes alone",
       bytes(in_all_bytes) AS "in all"
FROM prices;

/* {"rows": "below"} */
SELECT '' UNION ALL
SELECT 'alone: a scene of the effect and of the effects that it needs, minus a scene of these needed effects'
UNION ALL SELECT 'in all: the whole scene, minus the scene without the effect and without the effects that need it'
UNION ALL SELECT sentence FROM below_zero
UNION ALL SELECT '' UNION ALL
SELECT substr(effect || '              ', 1, 14) || work || char(10) || '              without: ' || lost
FROM prices
UNION ALL SELECT '';

/* {"rows": "end of the run"} */
SELECT iif(holds, 'holds   ', 'BROKEN  ') || claim || ' (' || evidence || ')' FROM checks
UNION ALL SELECT stopped || ' after ' || frames || ' frames.' FROM run WHERE stopped IS NOT NULL;

-- --- On the page ----------------------------------------------------------------------------------

/* {"sentences": "what they are", "section": "The price list"} */
SELECT 'Alone: a scene of the effect and of the effects that it needs, minus a scene of these needed effects. '
       || 'Within all: the whole scene, minus the scene without the effect and without the effects that need it. '
       || 'The two prices differ if effects share work: one update of the grid serves all effects.'
UNION ALL SELECT sentence FROM below_zero;

/* {"conclusions": "time limit", "section": "The price list"} */
SELECT stopped || ' after ' || frames || ' frames.' FROM texts WHERE stopped IS NOT NULL;

/* {"checks": "all", "section": "The price list"} */
SELECT claim, holds, evidence FROM checks;

/* {"sentences": "what is drawn", "section": "The prices, drawn"} */
SELECT 'Bars show medians, lines the 5th to the 95th percentile of the frames. If a bar is below zero, a frame '
       || 'takes less time with the effect than without the effect; the price list explains why.';

/* {"chart": "effects-time", "title": "Time that each effect takes",
    "settings": "{scene}; medians of {frames} frames", "mark": "bar", "x": "effect names", "y": "amount",
    "series": "price", "low": "low", "high": "high", "section": "The prices, drawn"} */
SELECT effect, which AS price, ms AS "amount: time [ms a frame]", low AS "low: 5th percentile [ms]",
       high AS "high: 95th percentile [ms]"
FROM differences ORDER BY differences.price, which;

/* {"chart": "effects-bytes", "title": "Memory that each effect takes",
    "settings": "{scene}; memory of all tables", "mark": "bar", "x": "effect names",
    "y": "amount", "series": "price", "section": "The prices, drawn"} */
SELECT effect, price, kib AS "amount: memory [KiB]"
FROM (SELECT rowid AS turn, effect, 'alone' AS price, alone_bytes / 1024.0 AS kib FROM prices
      UNION ALL SELECT rowid, effect, 'within all', in_all_bytes / 1024.0 FROM prices)
ORDER BY turn, price;

/* {"table": "prices", "section": "The price list"} */
SELECT effect, alone_ms AS "alone_ms: alone [ms]", in_all_ms AS "in_all_ms: within all [ms]",
       alone_bytes / 1024.0 AS "kib_alone: alone [KiB]", in_all_bytes / 1024.0 AS "kib_in_all: within all [KiB]",
       work AS "work: work in a frame", lost AS "lost: without the effect"
FROM prices;

/* {"settings": "scene", "section": "The price list"} */
SELECT scene || '.' FROM texts;

-- --- For programs ---------------------------------------------------------------------------------

-- Of a variant, in CSV and JSON.
CREATE TABLE figures (variant, name, member, number);
INSERT INTO figures
SELECT variant, name, member, number FROM (
    SELECT variant, 1 AS turn, 'frame_ms' AS name, 'frameMs.median' AS member, ms AS number FROM spreads
    UNION ALL SELECT variant, 2, 'p5_ms', 'frameMs.p5', low FROM spreads
    UNION ALL SELECT variant, 3, 'p95_ms', 'frameMs.p95', high FROM spreads
    UNION ALL SELECT variant, 4, 'bytes', 'bytes', bytes FROM spreads
    UNION ALL SELECT variant, 5, 'allocations', 'allocationsPerFrame', allocations FROM spreads
    UNION ALL SELECT variant, 5 + numbers.rowid, name || iif(kind = 'table', '_bytes', ''),
                     iif(kind = 'table', 'tables.', 'counters.') || name,
                     iif(kind = 'table', number, 1.0 * number / frames) FROM numbers, run)
ORDER BY variant, turn;

/* {"rows": "csv", "spread": true} */
SELECT effects, name, number FROM figures JOIN variants ON variants.rowid = variant ORDER BY figures.rowid;

/* {"rows": "checks"} */
SELECT claim, holds AS "holds?", evidence FROM checks;

/* {"rows": "prices"} */
SELECT effect, alone_ms AS "aloneMs.median", alone_low AS "aloneMs.p5", alone_high AS "aloneMs.p95",
       in_all_ms AS "inAllMs.median", in_all_low AS "inAllMs.p5", in_all_high AS "inAllMs.p95",
       alone_bytes AS aloneBytes, in_all_bytes AS inAllBytes, work, lost
FROM prices;

/* {"rows": "variants", "spread": true} */
SELECT list AS "effects{}", member, number FROM figures JOIN variants ON variants.rowid = variant
ORDER BY figures.rowid;

/* {"rows": "end"} */
SELECT frames, stopped IS NOT NULL AND NOT interrupted AS "timeLimitHit?", interrupted AS "interrupted?"
FROM run;
)sql"
