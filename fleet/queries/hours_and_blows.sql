-- Hours at work, blows and energy of each machine.
SELECT b.machine, count(*) AS runs, sum(r.duration) / 3600 AS hours, sum(r.blows) AS blows,
  sum(f.total) / 1e6 AS energy_MJ, min(r.day) AS first_day, max(r.day) AS last_day
FROM runs r JOIN bags b USING(bag_id) LEFT JOIN run_figures f ON f.run_id = r.run_id AND f.quantity = 'energy'
GROUP BY b.machine ORDER BY hours DESC, b.machine
