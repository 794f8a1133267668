-- Computed loads against measured ones, by machine and component: number of samples, error and scale, weighted by samples.
SELECT b.machine, e.component, e.unit, count(*) AS runs, sum(e.samples) AS samples,
  sqrt(sum(e.samples * e.rms_error * e.rms_error) / sum(e.samples)) AS rms_error,
  sqrt(sum(e.samples * e.rms * e.rms) / sum(e.samples)) AS rms,
  sum(e.samples * e.bias) / sum(e.samples) AS bias, sum(e.samples * e.scale) / sum(e.samples) AS scale
FROM reference e JOIN runs r USING(run_id) JOIN bags b USING(bag_id)
WHERE e.samples > 0 GROUP BY b.machine, e.component, e.unit ORDER BY b.machine, e.component
