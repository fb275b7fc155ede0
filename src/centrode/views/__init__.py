"""Views: what there is to say about each result, one module a topic; they make sheets and render nothing."""
