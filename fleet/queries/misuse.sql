-- Misuse by machine: strokes that found no tool, blows without press force and seconds beyond 15 s at one place, per hour.
SELECT b.machine, count(*) AS runs, sum(r.duration_s) / 3600 AS hours,
  3600.0 * sum(r.blank_strokes) / sum(r.duration_s) AS blank_strokes_per_hour,
  3600.0 * sum(r.unpressed_blows) / sum(CASE WHEN r.unpressed_blows IS NULL THEN 0 ELSE r.duration_s END)
    AS unpressed_blows_per_hour,
  3600.0 * sum(r.still_time_s) / sum(CASE WHEN r.still_time_s IS NULL THEN 0 ELSE r.duration_s END) AS still_s_per_hour
FROM runs r JOIN bags b USING(bag_id)
WHERE r.duration_s > 0 AND r.blank_strokes IS NOT NULL
GROUP BY b.machine ORDER BY blank_strokes_per_hour DESC, b.machine
