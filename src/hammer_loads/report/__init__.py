"""Pages, tables, checks, budgets and test reports from the databases of process_bag --db, ledgers and fleets."""
