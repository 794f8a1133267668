-- Life left where an S-N curve is given: damage so far, and hours until it is 1 at the rate so far.
SELECT machine, name AS place, hours, damage, remaining_hours
FROM machine_channels WHERE damage IS NOT NULL
ORDER BY damage DESC, machine, name
