"""One page and tables from the databases of process_bag --db and from ledgers. Needs the standard library alone."""
