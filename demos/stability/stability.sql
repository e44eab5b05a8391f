R"sql(-- SPDX-License-Identifier: Zlib
--
-- What `hashphase stability` shows. Measured are: run (one row), kinds (of broadphases), cases, and the outcome of
-- each kind in each case.

-- Whether ours is as required; null where ours was not asked. What each one does, in words.
CREATE TABLE judged AS
SELECT cases.*, holds, CASE holds WHEN 1 THEN 'holds' WHEN 0 THEN 'WRONG' ELSE '-' END AS verdict
FROM cases LEFT JOIN (SELECT id, min(holds) AS holds FROM outcomes JOIN kinds USING (broadphase)
                      WHERE ours GROUP BY id) USING (id)
ORDER BY cases.rowid;

CREATE TABLE details AS
SELECT id, ours, broadphase || ': ' || text
       || iif(compared > 0, ' (' || thousands(compared) || ' answers expected)', '')
       || iif(note <> '', '. ' || note, '') AS told
FROM outcomes JOIN kinds USING (broadphase) ORDER BY outcomes.rowid;

CREATE TABLE broken AS  -- of Bullet's
SELECT broadphase || ' in ' || sum(NOT holds) || ' of ' || count(*) AS told
FROM outcomes JOIN kinds USING (broadphase) WHERE NOT ours AND outcome <> 'nothing'
GROUP BY broadphase HAVING sum(NOT holds) > 0 ORDER BY kinds.rowid;

CREATE TABLE verdict AS
SELECT iif(EXISTS (SELECT 1 FROM kinds WHERE ours),
           (SELECT ifnull(sum(holds), 0) || ' of ' || count(*) || ' hard cases hold' FROM judged),
           'hashphase was not tested')
       || ifnull('; Bullet''s broadphases fail: ' || (SELECT group_concat(told, ', ') FROM broken), '')
       || left_out_text AS text,
       (SELECT min(holds) FROM judged) AS holds
FROM run;

CREATE VIEW cells AS
SELECT id, name, broadphase, text, grade
FROM (SELECT cases.rowid AS turn, cases.id, name, outcomes.rowid AS place, broadphase, text,
             CASE WHEN outcome = 'exact' THEN 'good' WHEN outcome IN ('extra', 'costly', 'refuses') THEN 'fair'
                  WHEN outcome <> 'nothing' THEN 'poor' END AS grade
      FROM cases JOIN outcomes USING (id)
      UNION ALL
      SELECT rowid, id, name, 1e9, 'verdict', verdict, CASE holds WHEN 1 THEN 'good' WHEN 0 THEN 'poor' END
      FROM judged)
ORDER BY turn, place;

CREATE VIEW texts AS
SELECT '-n: n answers missing; +n: n answers too many; nx: n times the cost of the reference; > n s: '
       || 'not finished within n s; -: the broadphase has no such query' AS legend;

/* {"verdict": "all"} */
SELECT text, holds FROM verdict;

-- --- On the terminal ------------------------------------------------------------------------------

/* {"print": "{legend}", "spread": true} */
SELECT id AS "id:  ", name AS "case", broadphase, text FROM cells;

/* {"rows": "explained"} */
SELECT char(10) || id || ' ' || name || ': ' || verdict || ', ' || fixed(seconds, 1) || ' s' || char(10)
       || '  input: ' || input || char(10) || '  required: ' || required
       || (SELECT group_concat(char(10) || '  ' || told, '') FROM details WHERE details.id = judged.id)
FROM judged, run WHERE is_explained OR holds = 0;

-- --- On the page ----------------------------------------------------------------------------------

/* {"sentences": "what is in a cell", "section": "What each one does"} */
SELECT 'A row for each case, a column for each broadphase. The verdict: whether hashphase meets the requirement. ' || legend
       || '.'
FROM texts;

/* {"graded": "What each broadphase does in each case",
    "legend": ["exact, as required", "too many answers, too costly, or refused", "wrong, hangs, or crashes"],
    "section": "What each one does"} */
SELECT id, name AS "case", broadphase, text, grade FROM cells;

/* {"each": "SELECT id, name FROM cases", "sentences": "case", "section": "{:id || ' ' || :name}"} */
SELECT 'Input: ' || input || '.' FROM judged WHERE id = :id
UNION ALL SELECT 'Required: ' || required || '.' FROM judged WHERE id = :id AND holds IS NULL;

/* {"each": "SELECT id, name FROM cases", "conclusions": "of Bullet's", "section": "{:id || ' ' || :name}"} */
SELECT told FROM details WHERE id = :id AND NOT ours;

/* {"each": "SELECT id, name FROM cases", "checks": "of ours", "section": "{:id || ' ' || :name}"} */
SELECT required, holds, (SELECT group_concat(told, '; ') FROM details WHERE id = :id AND ours)
FROM judged WHERE id = :id AND holds IS NOT NULL;

-- --- For programs ---------------------------------------------------------------------------------

/* {"rows": "csv"} */
SELECT id AS "case", name, broadphase, outcome, text, holds, compared, missing, extra, cost_ratio, note
FROM outcomes JOIN cases USING (id) ORDER BY outcomes.rowid;

/* {"rows": "end"} */
SELECT text AS "verdict.text", ifnull(holds, 1) AS "verdict.holds?" FROM verdict;

/* {"rows": "cases"} */
SELECT id, name, input, required, holds AS "holds?", seconds FROM judged;

/* {"rows": "outcomes"} */
SELECT id, broadphase, ours AS "ours?", outcome, text, holds AS "holds?", compared, missing, extra,
       cost_ratio AS costRatio, nullif(note, '') AS note
FROM outcomes JOIN kinds USING (broadphase) ORDER BY outcomes.rowid;
)sql"
