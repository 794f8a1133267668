-- Sensors to calibrate: a warning about the crank's sensor, estimate inconsistent (beyond 3), jitter, inertia unsure.
SELECT b.machine, count(DISTINCT r.run_id) AS runs, max(r.consistency) AS consistency,
  max(r.timing_noise) * 1000 AS jitter_ms, max(r.drive_inertia_relative_std) AS drive_inertia_relative_std,
  count(DISTINCT w.key) AS warnings, min(w.text) AS a_warning, max(r.day) AS last_day
FROM runs r JOIN bags b USING(bag_id)
LEFT JOIN warnings w ON w.run_id = r.run_id AND (
  w.key IN ('zero', 'eccentricity', 'zero off', 'inconsistent', 'inconsistent before', 'jitter', 'stamps', 'count', 'backward', 'degrees', 'frozen', 'lost')
  OR w.text LIKE '%calibrate%')
WHERE r.consistency > 3 OR r.timing_noise > 0.0001 OR r.drive_inertia_relative_std > 0.2 OR w.key IS NOT NULL
GROUP BY b.machine ORDER BY runs DESC, b.machine
