-- Lowest mean hold-down force (what holds the hull on the tool), by run.
SELECT b.machine, b.bag, r.day, f.mean / 1000 AS mean_kN, f.least / 1000 AS least_kN, f.greatest / 1000 AS greatest_kN
FROM run_figures f JOIN runs r USING(run_id) JOIN bags b USING(bag_id)
WHERE f.quantity = 'mean_hold_down_force' AND f.mean IS NOT NULL
ORDER BY f.mean, b.machine, b.bag LIMIT 20
