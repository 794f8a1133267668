-- Limits that were exceeded: alarms by machine and limit, their revolutions and the value farthest beyond the limit.
SELECT b.machine, a.name, a.unit, a.level, a.limit_value, count(*) AS alarms, sum(a.turns) AS turns,
  CASE WHEN min(a.value) < a.limit_value THEN min(a.value) ELSE max(a.value) END AS farthest_value,
  min(r.day) AS first_day, max(r.day) AS last_day
FROM alarms a JOIN runs r USING(run_id) JOIN bags b USING(bag_id)
GROUP BY b.machine, a.name, a.unit, a.level, a.limit_value ORDER BY a.level DESC, alarms DESC, b.machine, a.name
