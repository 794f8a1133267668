-- Highest peaks of the force along the tool.
SELECT b.machine, b.bag, r.day, f.greatest / 1000 AS peak_kN, f.mean / 1000 AS mean_peak_kN
FROM run_figures f JOIN runs r USING(run_id) JOIN bags b USING(bag_id)
WHERE f.quantity = 'amplitude' AND f.greatest IS NOT NULL
ORDER BY f.greatest DESC, b.machine, b.bag LIMIT 20
