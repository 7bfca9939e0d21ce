"""A page to play with: move a slider, see the impact.

``form``: the case schema as fields; ``answer``: a result as the page shows it; ``json_answers``:
events and errors; ``jobs``: few computations at a time, the newest first; ``surface_uploads``,
``upload_reader``: files dropped in, read in a process of their own; ``guard``: who may ask;
``requests``: what a request holds; ``exploring``: what is computed; ``missing_keys``: what a
choice asks for; ``app``: the routes; ``serving``: the server. The page itself is in ``static``.
"""
