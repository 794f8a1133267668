-- Bags that gave nothing, with the reason.
SELECT machine, bag, status, reason FROM bags WHERE status <> 'done' ORDER BY machine, bag
