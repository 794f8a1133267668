-- Boom health: stiffness of each cylinder's oil over that of the boom file by month (UTC), its change since the first.
SELECT machine, cylinder, month, runs, stiffness_ratio, std,
  100 * (stiffness_ratio / first_value(stiffness_ratio) OVER (PARTITION BY machine, cylinder ORDER BY month) - 1)
    AS change_percent
FROM (SELECT b.machine, c.cylinder, substr(r.day, 1, 7) AS month, count(*) AS runs,
        sum(c.turns * c.stiffness_ratio) / sum(c.turns) AS stiffness_ratio,
        avg(c.stiffness_ratio_std) AS std
      FROM run_cylinders c JOIN runs r USING(run_id) JOIN bags b USING(bag_id)
      WHERE c.doubtful < 0.5
      GROUP BY b.machine, c.cylinder, substr(r.day, 1, 7)) AS by_month
ORDER BY machine, cylinder, month
