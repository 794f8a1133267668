-- Refused samples by machine and reason, as a share of the machine's samples.
SELECT b.machine, x.reason, sum(x.count) AS refused,
  100.0 * sum(x.count) / (SELECT sum(o.samples) FROM runs o JOIN bags p USING(bag_id) WHERE p.machine = b.machine)
    AS percent
FROM refusals x JOIN runs r USING(run_id) JOIN bags b USING(bag_id)
GROUP BY b.machine, x.reason ORDER BY percent DESC, b.machine, x.reason
