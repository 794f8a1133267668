-- Energy given to the tools by week (ISO week, UTC).
SELECT r.week, b.machine, sum(f.total) / 1e6 AS energy_MJ, sum(r.blows) AS blows
FROM runs r JOIN bags b USING(bag_id) JOIN run_figures f USING(run_id)
WHERE f.quantity = 'energy'
GROUP BY r.week, b.machine ORDER BY r.week, b.machine
