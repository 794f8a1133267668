-- Most interrupted sensors: restarts of the estimate and passages backward, by hour of work.
SELECT b.machine, sum(r.restarts) AS restarts, sum(r.backward_passes) AS backward_passes,
  sum(r.duration) / 3600 AS hours, sum(r.restarts) * 3600.0 / sum(r.duration) AS restarts_per_hour
FROM runs r JOIN bags b USING(bag_id) WHERE r.duration > 0
GROUP BY b.machine ORDER BY restarts_per_hour DESC, b.machine
