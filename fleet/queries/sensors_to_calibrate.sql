-- Sensors to calibrate: estimate inconsistent (beyond 3), stamps that jitter (beyond 0.1 ms), or drive inertia unsure.
SELECT b.machine, count(*) AS runs, max(r.consistency) AS consistency, max(r.timing_noise_s) * 1000 AS jitter_ms,
  max(r.drive_inertia_deviation) AS drive_inertia_deviation, max(r.day) AS last_day
FROM runs r JOIN bags b USING(bag_id)
WHERE r.consistency > 3 OR r.timing_noise_s > 0.0001 OR r.drive_inertia_deviation > 0.2
GROUP BY b.machine ORDER BY runs DESC, b.machine
