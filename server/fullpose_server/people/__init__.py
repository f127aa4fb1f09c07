"""Who may use a server: roles, passwords, and the credentials that are known. Pure; rows are in `store.people`."""
