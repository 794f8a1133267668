-- Parameters that differ from the shipped ones, and on how many runs of which machines.
SELECT p.key, p.value, p.shipped, b.machine, count(*) AS runs, min(r.day) AS first_day, max(r.day) AS last_day
FROM parameter_values p JOIN runs r USING(parameters_sha256, version) JOIN bags b USING(bag_id)
WHERE p.shipped IS NULL OR p.value <> p.shipped
GROUP BY p.key, p.value, p.shipped, b.machine ORDER BY p.key, b.machine, p.value
