-- Blank turns: runs whose weakest turns stay below half of the mean peak, as when the tool does not reach the rock.
SELECT b.machine, b.bag, r.day, r.turns, f.least / 1000 AS weakest_peak_kN, f.mean / 1000 AS mean_peak_kN
FROM runs r JOIN bags b USING(bag_id) JOIN run_figures f USING(run_id)
WHERE f.quantity = 'amplitude' AND f.least < 0.5 * f.mean
ORDER BY f.least / f.mean, b.machine, b.bag LIMIT 50
