"""What page and API ask: states, quick answers, and jobs in processes that can be ended."""
