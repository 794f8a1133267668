-- Worst machines by damage-equivalent load: force along the tool, slope 5 (range, at the stated cycles an hour).
SELECT c.machine, c.hours, e.equivalent_range, e.std,
  c.equivalent_cycles_per_hour, c.largest_range
FROM machine_channels c JOIN machine_equivalents e USING(machine_channel)
WHERE c.name = 'hull_wrench/force_z' AND e.slope = 5
ORDER BY e.equivalent_range DESC, c.machine LIMIT 20
