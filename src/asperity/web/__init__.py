"""A page to play with: move a slider, see the impact.

``form``: the case schema as fields; ``answer``: a result as the page shows it; ``jobs``: few
computations at a time, the newest first; ``surfaces``: files dropped in, read in a process of
their own; ``guard``: who may ask; ``asking``: what a request holds; ``app``: the routes;
``serving``: the server. The page itself is in ``static``.
"""
