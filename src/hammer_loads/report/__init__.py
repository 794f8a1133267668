"""Pages, tables, budgets and certificates from the databases of process_bag --db, ledgers and fleets."""
