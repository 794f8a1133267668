-- Misuse by machine: blank firing, blows without hold-down force and seconds beyond 15 s at one place, per hour.
SELECT b.machine, count(*) AS runs, sum(r.duration) / 3600 AS hours,
  3600.0 * sum(r.blank_firings) / sum(r.duration) AS blank_firings_per_hour,
  3600.0 * sum(r.blows_without_hold_down) / sum(CASE WHEN r.blows_without_hold_down IS NULL THEN 0 ELSE r.duration END)
    AS blows_without_hold_down_per_hour,
  3600.0 * sum(r.still_time) / sum(CASE WHEN r.still_time IS NULL THEN 0 ELSE r.duration END) AS still_s_per_hour
FROM runs r JOIN bags b USING(bag_id)
WHERE r.duration > 0 AND r.blank_firings IS NOT NULL
GROUP BY b.machine ORDER BY blank_firings_per_hour DESC, b.machine
