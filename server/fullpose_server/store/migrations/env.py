"""Alembic's entry: runs inside the connection that `fullpose_server.store.database.migrate` hands over."""

from alembic import context

from fullpose_server.store.tables import Table

connection = context.config.attributes["connection"]
# SQLite cannot alter most things in place: batch mode copies the table.
context.configure(connection=connection, target_metadata=Table.metadata, render_as_batch=True)
with context.begin_transaction():
    context.run_migrations()
